// Bodies from files: the shape, the colours and the unit that the file states, and clear errors for what is broken.
#include "acquire/rig/mesh_file.h"

#include <fstream>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/support/temp_dir.h"

namespace striae::rig {
namespace {

const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n"
    "property list uchar int vertex_indices\nend_header\n"
    "0 0 0 255 0 0\n30 0 0 255 0 0\n0 20 0 255 0 0\n30 20 0 255 0 0\n3 0 2 1\n3 1 2 3\n";
const std::string kObj = "v 0 0 0 1 0.5 0\nv 30 0 0 1 0.5 0\nv 0 20 0 1 0.5 0\nv 30 20 0 1 0.5 0\nf 1 3 2\nf 2 3 4\n";
const std::string kStl =
    "solid card\nfacet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 20 0\nvertex 30 0 0\nendloop\nendfacet\n"
    "facet normal 0 0 -1\nouter loop\nvertex 30 0 0\nvertex 0 20 0\nvertex 30 20 0\nendloop\nendfacet\nendsolid card\n";

class MeshFile : public ::testing::Test {
 protected:
  std::filesystem::path Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  testing::TempDir folder_;
};

double Area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangle) {
    sum += (mesh.vertex[t[1]] - mesh.vertex[t[0]]).cross(mesh.vertex[t[2]] - mesh.vertex[t[0]]).norm() / 2;
  }
  return sum;
}

TEST_F(MeshFile, EveryFormatGivesTheSameCard) {
  for (const auto& [name, text] :
       {std::pair{"card.ply", kPly}, std::pair{"card.obj", kObj}, std::pair{"card.STL", kStl}}) {
    const auto mesh = ReadMesh(Write(name, text), {});
    ASSERT_TRUE(mesh) << name << ": " << mesh.error().Describe();
    EXPECT_EQ(mesh->triangle.size(), 2U) << name;
    EXPECT_NEAR(Area(*mesh), 600, 1e-3) << name;
    for (const Eigen::Vector3d& normal : mesh->normal) EXPECT_LT(normal.z(), -0.999) << name;
  }
}

TEST_F(MeshFile, ColoursAreLinearLight) {
  const auto ply = ReadMesh(Write("card.ply", kPly), {}), obj = ReadMesh(Write("card.obj", kObj), {});
  ASSERT_TRUE(ply && obj);
  EXPECT_NEAR(ply->albedo[0].x(), 1, 1e-6);
  EXPECT_NEAR(ply->albedo[0].y(), 0, 1e-6);
  EXPECT_NEAR(obj->albedo[0].y(), 0.2140, 1e-3);  // sRGB 0.5, IEC 61966-2-1
  EXPECT_NEAR(ReadMesh(Write("card.stl", kStl), {})->albedo[0].y(), 0.6, 1e-6) << "no colour in the file";
}

TEST_F(MeshFile, UnitAndAxesLeadToTheCameraFrame) {
  MeshFileOptions options;
  options.unit_mm = 10;
  options.axes = MeshAxes::kYUp;
  const auto mesh = ReadMesh(Write("card.obj", kObj), options);
  ASSERT_TRUE(mesh);
  double lowest = 0;
  for (const Eigen::Vector3d& v : mesh->vertex) lowest = std::min(lowest, v.y());
  EXPECT_NEAR(lowest, -200, 1e-6) << "20 cm up is -200 mm of the camera's y";
}

TEST_F(MeshFile, WhatIsBrokenIsSaidSo) {
  EXPECT_EQ(ReadMesh(folder_ / "absent.ply", {}).error().code, ErrorCode::kNotFound);
  EXPECT_EQ(ReadMesh(Write("card.txt", kObj), {}).error().code, ErrorCode::kUsage);
  EXPECT_EQ(ReadMesh(Write("empty.obj", ""), {}).error().code, ErrorCode::kBadFile);
  EXPECT_EQ(ReadMesh(Write("noise.stl", std::string(60, '\x07')), {}).error().code, ErrorCode::kBadFile);
  EXPECT_EQ(ReadMesh(Write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), {}).error().code, ErrorCode::kBadFile);
  EXPECT_EQ(ReadMesh(Write("cut.ply", kPly.substr(0, 120)), {}).error().code, ErrorCode::kBadFile);
  MeshFileOptions tiny;
  tiny.unit_mm = 1e-3;
  EXPECT_EQ(ReadMesh(Write("card.obj", kObj), tiny).error().code, ErrorCode::kUsage) << "a body of 0.03 mm";
  MeshFileOptions few;
  few.most_triangles = 1;
  EXPECT_EQ(ReadMesh(Write("card.ply", kPly), few).error().code, ErrorCode::kBadFile);
}

TEST_F(MeshFile, AMissingPictureIsNamed) {
  Write("card.mtl", "newmtl skin\nKd 1 1 1\nmap_Kd skin.png\n");
  const auto mesh = ReadMesh(Write("card.obj",
                                   "mtllib card.mtl\nusemtl skin\nv 0 0 0\nv 30 0 0\nv 0 20 0\nvt 0 0\nvt 1 "
                                   "0\nvt 0 1\nf 1/1 3/3 2/2\n"),
                             {});
  ASSERT_FALSE(mesh);
  EXPECT_EQ(mesh.error().code, ErrorCode::kNotFound);
  EXPECT_NE(mesh.error().message.find("skin.png"), std::string::npos);
}

}  // namespace
}  // namespace striae::rig
