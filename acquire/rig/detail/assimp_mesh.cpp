#include "acquire/rig/detail/assimp_mesh.h"

#include <algorithm>
#include <map>
#include <memory>
#include <string>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <opencv2/imgcodecs.hpp>

#include "acquire/rig/detail/srgb.h"

namespace striae::rig::detail {
namespace {

constexpr float kPlain = 0.6F;          // linear albedo of what has no colour
constexpr float kSmoothing_deg = 50;    // facets that meet at less are one smooth surface
constexpr int kLargestTexture = 16384;  // px a side

/// Parts of a file as they become one mesh.
class Collector {
 public:
  Collector(const aiScene& scene, std::filesystem::path folder) : scene_(scene), folder_(std::move(folder)) {}

  Status Add(const aiMesh& part) {
    if ((part.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0) return {};
    const aiMaterial& material = *scene_.mMaterials[part.mMaterialIndex];
    const bool coloured = part.HasVertexColors(0);
    int picture = -1;
    if (!coloured && part.HasTextureCoords(0) && material.GetTextureCount(aiTextureType_DIFFUSE) > 0) {
      const auto loaded = Picture(material);
      if (!loaded) return Fail(loaded.error());
      picture = *loaded;
    }
    const Eigen::Vector3f plain = picture >= 0 ? Eigen::Vector3f(Eigen::Vector3f::Ones()) : Diffuse(material);
    const auto first = static_cast<std::uint32_t>(mesh_.vertex.size());
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D &v = part.mVertices[i], n = part.HasNormals() ? part.mNormals[i] : aiVector3D(0, 0, -1);
      mesh_.vertex.emplace_back(v.x, v.y, v.z);
      mesh_.normal.emplace_back(n.x, n.y, n.z);
      if (!mesh_.normal.back().allFinite()) mesh_.normal.back() = -Eigen::Vector3d::UnitZ();
      mesh_.albedo.push_back(coloured ? Linear(part.mColors[0][i]) : plain);
      const bool placed = part.HasTextureCoords(0);  // their origin is the picture's lower left corner
      mesh_.uv.emplace_back(placed ? part.mTextureCoords[0][i].x : 0, placed ? 1 - part.mTextureCoords[0][i].y : 0);
    }
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      if (face.mNumIndices != 3) continue;
      mesh_.triangle.push_back({first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
      mesh_.texture_of_triangle.push_back(picture);
    }
    return {};
  }

  TriangleMesh Take() {
    if (mesh_.texture.empty()) {
      mesh_.uv.clear();
      mesh_.texture_of_triangle.clear();
    }
    return std::move(mesh_);
  }

 private:
  static Eigen::Vector3f Linear(const aiColor4D& c) { return {FromSrgb(c.r), FromSrgb(c.g), FromSrgb(c.b)}; }

  static Eigen::Vector3f Diffuse(const aiMaterial& material) {
    aiString name;
    aiColor4D colour;
    const bool named = material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS;
    // What the library adds to files without material is called so.
    const bool given = named && name.length > 0 && std::string(name.C_Str()) != AI_DEFAULT_MATERIAL_NAME;
    if (!given || material.Get(AI_MATKEY_COLOR_DIFFUSE, colour) != aiReturn_SUCCESS) {
      return Eigen::Vector3f::Constant(kPlain);
    }
    return Linear(colour);
  }

  /// Index of the material's picture among the mesh's textures.
  Result<int> Picture(const aiMaterial& material) {
    aiString name;
    material.GetTexture(aiTextureType_DIFFUSE, 0, &name);
    std::string file = name.C_Str();
    std::replace(file.begin(), file.end(), '\\', '/');
    const auto known = pictures_.find(file);
    if (known != pictures_.end()) return known->second;
    const std::filesystem::path path = folder_ / file;
    if (!std::filesystem::exists(path)) {
      return Fail(ErrorCode::kNotFound, "the mesh's picture " + path.string() + " is absent; put it beside the mesh");
    }
    const cv::Mat bgr = cv::imread(path.string(), cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
    if (bgr.empty() || bgr.cols > kLargestTexture || bgr.rows > kLargestTexture) {
      return Fail(ErrorCode::kBadFile, "the mesh's picture " + path.string() + " cannot be read, or is too large");
    }
    auto picture = std::make_shared<ImageRgb>(bgr.cols, bgr.rows);
    for (int row = 0; row < bgr.rows; ++row) {
      for (int col = 0; col < bgr.cols; ++col) {
        const auto& pixel = bgr.at<cv::Vec3b>(row, col);
        (*picture)(col, row) = {pixel[2], pixel[1], pixel[0]};
      }
    }
    mesh_.texture.push_back(std::move(picture));
    return pictures_[file] = static_cast<int>(mesh_.texture.size()) - 1;
  }

  const aiScene& scene_;
  std::filesystem::path folder_;
  std::map<std::string, int> pictures_;
  TriangleMesh mesh_;
};

Result<TriangleMesh> Read(const std::filesystem::path& path, std::size_t most_triangles) {
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, kSmoothing_deg);
  // A file's own normals are often facets' or absent: they are always made anew.
  const aiScene* scene = importer.ReadFile(
      path.string(), aiProcess_ValidateDataStructure | aiProcess_RemoveComponent | aiProcess_Triangulate |
                         aiProcess_SortByPType | aiProcess_GenSmoothNormals | aiProcess_JoinIdenticalVertices);
  if (scene == nullptr) {
    return Fail(ErrorCode::kBadFile,
                "cannot read " + path.string() + " (" + importer.GetErrorString() + "); export the mesh again");
  }
  std::size_t triangles = 0;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) triangles += scene->mMeshes[i]->mNumFaces;
  if (triangles > most_triangles) {
    return Fail(ErrorCode::kBadFile, path.string() + " has " + std::to_string(triangles) + " triangles, more than " +
                                         std::to_string(most_triangles) + "; decimate it");
  }
  Collector collector(*scene, path.parent_path());
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    if (Status added = collector.Add(*scene->mMeshes[i]); !added) return Fail(added.error());
  }
  TriangleMesh mesh = collector.Take();
  if (mesh.triangle.empty()) {
    return Fail(ErrorCode::kBadFile, path.string() + " has no triangles; the virtual rig needs a surface, not points");
  }
  return mesh;
}

}  // namespace

Result<TriangleMesh> ReadWithAssimp(const std::filesystem::path& path, std::size_t most_triangles) {
  try {
    return Read(path, most_triangles);
  } catch (const std::exception& error) {
    return Fail(ErrorCode::kBadFile, "cannot read " + path.string() + " (" + error.what() + "); export the mesh again");
  }
}

}  // namespace striae::rig::detail
