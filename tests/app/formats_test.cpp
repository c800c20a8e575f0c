// Every format that `striae reconstruct` writes, read back by its own codecs and by an independent reader (assimp).
#include <filesystem>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>

#include "core/obj.h"
#include "core/ply.h"
#include "core/stl.h"
#include "tests/app/striae_program.h"
#include "tests/support/files.h"
#include "tests/support/temp_dir.h"

namespace striae {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::Ran;
using testing::ReadBytes;
using testing::ReadText;
using testing::Striae;
using testing::TempDir;

/// A half-size limb, written once in every format.
class Written {
 public:
  static const Written& Get() {
    static const Written written;
    return written;
  }
  [[nodiscard]] fs::path At(const std::string& name) const { return folder_ / name; }
  nlohmann::json document;

 private:
  Written() {
    const Ran simulated = Striae({"simulate", "limb", "--scale", "0.5", "--out", (folder_ / "limb").string()});
    if (simulated.exit_code != 0) throw std::runtime_error(simulated.err);
    const Ran ran = Striae({"reconstruct", At("limb/limb.jpg"), "--calibration", At("limb/calibration.json"), "--out",
                            At("s.ply"), "--also", At("few.ply"), "--also", At("few.stl"), "--also", At("few.obj"),
                            "--decimate", "8000", "--preview", At("pictures"), "--json"});
    if (ran.exit_code != 0) throw std::runtime_error(ran.err);
    document = ran.Json();
  }
  TempDir folder_;
};

struct Box {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1e9F), high = -low;
  void Take(const Eigen::Vector3f& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};
Box BoxOf(const Surface& surface) {
  Box box;
  for (const auto& face : surface.faces) {
    for (const auto corner : face) box.Take(surface.point_in_camera[corner]);
  }
  return box;
}

/// Within the deviation that the program states, and the reader sees the same triangles.
void ExpectSameShape(const Surface& found) {
  const auto full = DecodePly(ReadBytes(Written::Get().At("s.ply")));
  ASSERT_TRUE(full);
  EXPECT_LE(found.faces.size(), 8000U);
  EXPECT_GT(found.faces.size(), 7000U);
  const double deviation = Written::Get().document.at("decimated").at("deviation_max_mm");
  const Box expected = BoxOf(*full), box = BoxOf(found);
  EXPECT_LT((box.low - expected.low).cwiseAbs().maxCoeff(), deviation + 1);
  EXPECT_LT((box.high - expected.high).cwiseAbs().maxCoeff(), deviation + 1);
}

TEST(Formats, TheMainPlyKeepsEveryPointWhateverIsDecimated) {
  const auto full = DecodePly(ReadBytes(Written::Get().At("s.ply")));
  ASSERT_TRUE(full) << full.error().message;
  EXPECT_EQ(full->size(), Written::Get().document.at("points"));
  EXPECT_GT(full->faces.size(), 100'000U);
}

TEST(Formats, DecimatedFilesAreReadByOurOwnCodecs) {
  const auto ply = DecodePly(ReadBytes(Written::Get().At("few.ply")));
  const auto stl = DecodeStl(ReadBytes(Written::Get().At("few.stl")));
  const auto obj = DecodeObj(ReadText(Written::Get().At("few.obj")));
  ASSERT_TRUE(ply && stl && obj);
  ExpectSameShape(*ply);
  ExpectSameShape(*stl);
  ExpectSameShape(*obj);
  EXPECT_EQ(obj->faces, ply->faces);
}

TEST(Formats, AssimpReadsThemAll) {
  for (const char* name : {"few.ply", "few.stl", "few.obj"}) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(Written::Get().At(name).string(), aiProcess_JoinIdenticalVertices);
    ASSERT_NE(scene, nullptr) << name << importer.GetErrorString();
    ASSERT_EQ(scene->mNumMeshes, 1U) << name;
    const aiMesh& mesh = *scene->mMeshes[0];
    EXPECT_EQ(mesh.mNumFaces, Written::Get().document.at("decimated").at("faces")) << name;
    if (std::string(name) != "few.obj") continue;
    ASSERT_TRUE(mesh.HasTextureCoords(0));
    aiString texture;
    scene->mMaterials[mesh.mMaterialIndex]->GetTexture(aiTextureType_DIFFUSE, 0, &texture);
    EXPECT_STREQ(texture.C_Str(), "few.jpg");
  }
}

TEST(Formats, TheTextureHasAPointsColourAtItsCoordinates) {
  const auto ply = DecodePly(ReadBytes(Written::Get().At("few.ply")));
  ASSERT_TRUE(ply);
  const cv::Mat texture = cv::imread(Written::Get().At("few.jpg").string());
  ASSERT_EQ(texture.cols, ply->sensor_width_px);
  ASSERT_EQ(texture.rows, ply->sensor_height_px);
  double error = 0;
  for (std::size_t i = 0; i < ply->size(); ++i) {
    error += std::abs(texture.at<cv::Vec3b>(ply->row[i], ply->col[i])[1] - ply->colour[i].g);
  }
  EXPECT_LT(error / static_cast<double>(ply->size()), 3);  // JPEG at quality 92
}

TEST(Formats, PreviewsAreWritten) {
  for (const char* name : {"photo", "shaded", "depth", "phase", "mask", "modulation"}) {
    const cv::Mat picture = cv::imread((Written::Get().At("pictures") / (std::string(name) + ".png")).string());
    ASSERT_FALSE(picture.empty()) << name;
    EXPECT_LE(std::max(picture.cols, picture.rows), 1600) << name;
    cv::Scalar mean, deviation;
    cv::meanStdDev(picture, mean, deviation);
    EXPECT_GT(deviation[0] + deviation[1] + deviation[2], 20) << name << " shows something";
  }
}

TEST(Formats, AnUnknownOneIsWrongUsageAndLeavesNothing) {
  const TempDir out;
  const Ran ran = Striae({"reconstruct", Written::Get().At("limb/limb.jpg"), "--calibration",
                          Written::Get().At("limb/calibration.json"), "--out", out / "s.ply", "--also", out / "s.xyz"});
  EXPECT_EQ(ran.exit_code, 2) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr(".ply, .stl or .obj"));
  EXPECT_TRUE(fs::is_empty(out.path()));
}

TEST(Formats, WhenOneFileCannotBeWrittenNoneStays) {
  const TempDir out;
  fs::create_directory(out / "blocked.mtl");  // a folder where the material should go
  const Ran ran = Striae({"reconstruct", Written::Get().At("limb/limb.jpg"), "--calibration",
                          Written::Get().At("limb/calibration.json"), "--out", out / "s.ply", "--also",
                          out / "blocked.obj", "--decimate", "4000"});
  EXPECT_EQ(ran.exit_code, 1) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("blocked.mtl"));
  EXPECT_EQ(std::distance(fs::directory_iterator(out.path()), {}), 1);
}

}  // namespace
}  // namespace striae
