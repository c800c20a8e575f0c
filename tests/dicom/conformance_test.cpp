// The three objects before the judges that hospitals use: dciodvfy, dcentvfy (dicom3tools), dsrdump, dcmdump (DCMTK).
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dicom/photo.h"
#include "dicom/surface_model.h"
#include "tests/dicom/samples.h"
#include "tests/dicom/tools.h"
#include "tests/support/temp_dir.h"

namespace striae::dicom::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::filesystem::path Put(const striae::testing::TempDir& folder, const Object& object) {
  auto path = folder / (std::string(ToString(object.reference.kind)) + ".dcm");
  WriteBytes(path, object.bytes);
  return path;
}

TEST(Conformance, DciodvfyFindsNoErrorInAnyOfTheThreeObjects) {
  STRIAE_NEED_TOOL("dciodvfy");
  const striae::testing::TempDir folder;
  const ThreeObjects objects = MakeObjects();
  for (const Object* object : objects.All()) {
    const ToolResult verdict = RunTool({"dciodvfy", "-new", Put(folder, *object).string()});
    EXPECT_THAT(verdict.output, Not(HasSubstr("Error"))) << ToString(object->reference.kind);
    // The one warning that stays is about codes of our own, which no validator can know.
    std::string line;
    for (std::istringstream lines(verdict.output); std::getline(lines, line);) {
      if (line.find("Warning") != std::string::npos) {
        EXPECT_THAT(line, HasSubstr("CodingSchemeUID"));
      }
    }
    EXPECT_EQ(verdict.exit_code, 0) << verdict.output;
  }
}

}  // namespace
}  // namespace striae::dicom::testing
