#include "tests/support/temp_dir.h"

#include <cstdlib>
#include <stdexcept>

namespace striae::testing {

TempDir::TempDir() {
  std::string name = (std::filesystem::temp_directory_path() / "striae-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
  path_ = name;
}

TempDir::~TempDir() {
  std::error_code ignored;
  // Objects of a study are read-only; make them removable first.
  for (const auto& entry : std::filesystem::recursive_directory_iterator(path_, ignored)) {
    if (entry.is_symlink(ignored)) continue;
    std::filesystem::permissions(entry.path(), std::filesystem::perms::owner_all, std::filesystem::perm_options::add,
                                 ignored);
  }
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace striae::testing
