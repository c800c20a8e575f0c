#include "app/io/surface_files.h"

#include <algorithm>
#include <cctype>
#include <system_error>

#include "app/io/files.h"
#include "app/io/ply_file.h"
#include "core/obj.h"
#include "core/ply.h"
#include "core/stl.h"
#include "dicom/thin.h"
#include "reconstruct/decimate.h"
#include "report/picture.h"

namespace striae::app {
namespace {

namespace fs = std::filesystem;

/// The files of an OBJ, what it refers to first: an OBJ that is there is whole.
Status WriteObj(const Surface& surface, const fs::path& path, std::vector<fs::path>& written) {
  fs::path mtl = path, texture = path;
  mtl.replace_extension(".mtl");
  texture.replace_extension(".jpg");
  const bool textured = surface.HasGrid();
  if (textured) {
    constexpr int kQuality = 92;
    const auto jpeg = report::EncodeJpeg(TextureOf(surface), kQuality);
    if (!jpeg) return Fail(jpeg.error());
    if (Status s = WriteFile(texture, *jpeg, Kept::kSystem); !s) return s;
    written.push_back(texture);
    if (Status s = WriteText(mtl, EncodeMtl(texture.filename().string())); !s) return s;
    written.push_back(mtl);
  }
  const std::string text = EncodeObj(surface, textured ? mtl.filename().string() : "");
  if (Status s = WriteFile(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, Kept::kSystem);
      !s) {
    return s;
  }
  written.push_back(path);
  return {};
}

Status WriteAs(SurfaceFormat format, const Surface& surface, const fs::path& path, std::vector<fs::path>& written) {
  if (format == SurfaceFormat::kObj) return WriteObj(surface, path, written);
  Status status;
  if (format == SurfaceFormat::kStl) {
    status = WriteFile(path, EncodeStl(surface, "Striae surface, mm, camera frame"), Kept::kSystem);
  } else {
    status = WritePly([&](const PieceSink& sink) { return EncodePly(surface, sink); }, path);
  }
  if (status) written.push_back(path);
  return status;
}

}  // namespace

Result<SurfaceFormat> FormatOf(const fs::path& path, const std::string& name) {
  std::string word = name.empty() ? path.extension().string() : "." + name;
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
  if (word == ".ply") return SurfaceFormat::kPly;
  if (word == ".stl") return SurfaceFormat::kStl;
  if (word == ".obj") return SurfaceFormat::kObj;
  return Fail(ErrorCode::kUsage, "the format of " + path.string() + " is not known; end it in .ply, .stl or .obj");
}

Result<std::vector<fs::path>> WriteSurface(const Surface& surface, const fs::path& path, SurfaceFormat format) {
  if (format != SurfaceFormat::kPly && surface.faces.empty()) {
    return Fail(ErrorCode::kUsage, "STL and OBJ are made of faces; leave out --no-faces, or write a PLY");
  }
  std::vector<fs::path> written;
  if (Status status = WriteAs(format, surface, path, written); !status) {
    std::error_code code;
    for (const fs::path& file : written) fs::remove(file, code);
    return Fail(status.error());
  }
  return written;
}

Result<DecimatedSurface> DecimateForFile(const Surface& surface, std::size_t faces) {
  constexpr std::size_t kCollapseFrom = 8, kFewestToCollapse = 100'000;
  auto thinned = dicom::ThinSurface(surface, std::max(kCollapseFrom * faces, kFewestToCollapse));
  if (!thinned) return Fail(thinned.error());
  auto decimated = reconstruct::Decimate(thinned->surface, faces);
  if (!decimated) return Fail(decimated.error());
  const auto deviation = reconstruct::DeviationFrom(surface, *decimated);
  if (!deviation) return Fail(deviation.error());
  return DecimatedSurface{*std::move(decimated), deviation->largest_mm, deviation->rms_mm};
}

}  // namespace striae::app
