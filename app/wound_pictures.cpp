#include "app/wound_pictures.h"

#include <algorithm>
#include <cmath>

#include "app/io/colour_bar.h"
#include "app/io/files.h"
#include "app/io/photograph.h"
#include "app/wound_view.h"
#include "core/surface_comments.h"
#include "report/drawing.h"
#include "report/picture.h"

namespace striae::app {
namespace {

namespace fs = std::filesystem;

constexpr double kDeepest_mm = 15;  // of the depth map's scale
constexpr Rgb8 kLine{40, 220, 255}, kNothing{235, 235, 235}, kInk{40, 40, 40}, kSkin{190, 120, 90}, kBed{160, 20, 30};

// Cells are 0.3 mm: small wounds would be stamps.
int EnlargementOf(const ImageRgb& picture) {
  constexpr double kWide_px = 720;
  return std::clamp(static_cast<int>(std::lround(kWide_px / std::max(1, picture.width()))), 1, 8);
}

ImageRgb Enlarged(const ImageRgb& picture, int times) {
  ImageRgb large(picture.width() * times, picture.height() * times);
  for (int row = 0; row < large.height(); ++row) {
    for (int col = 0; col < large.width(); ++col) large(col, row) = picture(col / times, row / times);
  }
  return large;
}

// Below the picture: how long 10 mm are in its middle (left out for 0 pixels a mm), and what is seen.
ImageRgb WithFooter(const ImageRgb& picture, double px_per_mm, const std::string& text) {
  constexpr int kHigh_px = 26;
  report::Drawing footer;
  footer.width = picture.width();
  footer.height = kHigh_px;
  if (px_per_mm > 0) footer.Line({{10, 14}, {10 + 10 * px_per_mm, 14}}, 2, kInk);
  footer.Text({16 + 10 * px_per_mm, 18}, 12, (px_per_mm > 0 ? "10 mm   " : "") + text, kInk);
  ImageRgb whole(picture.width(), picture.height() + kHigh_px, Rgb8{255, 255, 255});
  Paste(picture, 0, 0, whole);
  Paste(Rasterise(footer, 1), 0, picture.height(), whole);
  return whole;
}

// `first_px` is the sensor pixel in the picture's corner, and `times` its pixels for one of the sensor.
void DrawOutline(const Outline& outline, const Eigen::Vector2d& first_px, double times, ImageRgb& picture) {
  const std::size_t n = outline.polygon_px.size();
  const Eigen::Vector2d half(0.5, 0.5);  // integers are the middles of pixels
  const auto cell = [&](const Eigen::Vector2d& p) { return Eigen::Vector2d((p - first_px + half) * times - half); };
  for (std::size_t k = 0; k < n; ++k) {
    const Eigen::Vector2d a = cell(outline.polygon_px[k]), b = cell(outline.polygon_px[(k + 1) % n]);
    const int steps = 1 + static_cast<int>(2 * (b - a).norm());
    for (int s = 0; s <= steps; ++s) {
      const Eigen::Vector2d p = a + (b - a) * s / steps;
      const int col = static_cast<int>(std::lround(p.x())), row = static_cast<int>(std::lround(p.y()));
      for (const auto& [dc, dr] : {std::pair{0, 0}, std::pair{1, 0}, std::pair{0, 1}}) {
        if (picture.Contains(col + dc, row + dr)) picture(col + dc, row + dr) = kLine;
      }
    }
  }
}

// The surface's colours, which the stripes are taken out of, cell by cell.
ImageRgb Photo(const Surface& surface, const wound::WoundMaps& maps) {
  ImageRgb picture(maps.depth_mm.width(), maps.depth_mm.height(), kNothing);
  for (std::size_t k = 0; k < surface.size() && k < surface.colour.size(); ++k) {
    if (surface.col[k] < maps.col0_px || surface.row[k] < maps.row0_px) continue;
    const int col = (surface.col[k] - maps.col0_px) / maps.cell_px,
              row = (surface.row[k] - maps.row0_px) / maps.cell_px;
    if (picture.Contains(col, row)) picture(col, row) = surface.colour[k];
  }
  return picture;
}

ImageRgb Depths(const wound::WoundMaps& maps) {
  const ImageF& depth = maps.depth_mm;
  ImageRgb picture(depth.width(), depth.height());
  for (int row = 0; row < depth.height(); ++row) {
    for (int col = 0; col < depth.width(); ++col) {
      const float d = depth(col, row);
      picture(col, row) = std::isfinite(d) ? Viridis(static_cast<double>(d) / kDeepest_mm) : kNothing;
    }
  }
  return picture;
}

ImageRgb WithDepthBar(const ImageRgb& picture) {
  ImageRgb whole(picture.width() + static_cast<int>(kBarWidth) + 1, picture.height(), Rgb8{255, 255, 255});
  Paste(picture, 0, 0, whole);
  Paste(ColourBar({0, kDeepest_mm, "mm", false}, picture.height(), 1), picture.width(), 0, whole);
  return whole;
}

// One section with equal scales both ways; NaN parts the bed's line.
void DrawSection(const wound::WoundSection& section, const std::string& title, double top_pt, double pt_per_mm,
                 report::Drawing& drawing) {
  double high = -1e9;
  for (const double z : section.skin_mm) high = std::max(high, z);
  const auto point = [&](std::size_t k, double z) {
    return report::Point{20 + section.along_mm[k] * pt_per_mm, top_pt + 14 + (high - z) * pt_per_mm};
  };
  drawing.Text({20, top_pt + 6}, 8, title, kInk);
  std::vector<report::Point> skin, bed;
  const auto end_bed = [&] {
    if (bed.size() > 1) drawing.Line(bed, 1.2, kBed);
    bed.clear();
  };
  for (std::size_t k = 0; k < section.along_mm.size(); ++k) {
    skin.push_back(point(k, section.skin_mm[k]));
    if (std::isfinite(section.bed_mm[k])) {
      bed.push_back(point(k, section.bed_mm[k]));
    } else {
      end_bed();
    }
  }
  end_bed();
  if (skin.size() > 1) drawing.Line(skin, 1, kSkin, true);
}

double HeightOf(const wound::WoundSection& section) {
  double low = 1e9, high = -1e9;
  for (std::size_t k = 0; k < section.along_mm.size(); ++k) {
    low = std::min(low, section.skin_mm[k]);
    high = std::max(high, section.skin_mm[k]);
    if (std::isfinite(section.bed_mm[k])) low = std::min(low, section.bed_mm[k]);
  }
  return std::max(0.0, high - low);
}

report::Drawing Sections(const wound::WoundMaps& maps) {
  report::Drawing drawing;
  const double longest = std::max({1.0, maps.longest.along_mm.back(), maps.across.along_mm.back()});
  const double pt_per_mm = 440 / longest;
  const double first = HeightOf(maps.longest) * pt_per_mm + 40, second = HeightOf(maps.across) * pt_per_mm + 40;
  drawing.width = 480;
  drawing.height = first + second + 16;
  drawing.description = "Sections of the wound: measured bed (full) and virtual skin (dashed)";
  DrawSection(maps.longest, "along the longest axis", 4, pt_per_mm, drawing);
  DrawSection(maps.across, "across it", first, pt_per_mm, drawing);
  const double y = drawing.height - 8;
  drawing.Line({{20, y}, {20 + 10 * pt_per_mm, y}}, 1.5, kInk);
  drawing.Text({24 + 10 * pt_per_mm, y + 3}, 8, "10 mm; dashed: virtual skin, full: measured bed", kInk);
  return drawing;
}

}  // namespace

Result<std::vector<std::string>> WriteWoundPictures(const fs::path& folder, const Surface& surface,
                                                    const Outline& outline, const wound::WoundMaps& maps) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) return Fail(ErrorCode::kIo, "cannot make the folder " + folder.string() + ": " + failed.message());
  const ImageRgb colours = Photo(surface, maps);
  const int times = EnlargementOf(colours);
  const double px_per_mm = times / maps.cell_mm;
  ImageRgb photo = Enlarged(colours, times), depth = Enlarged(Depths(maps), times);
  const Eigen::Vector2d first_px(maps.col0_px, maps.row0_px);
  for (ImageRgb* picture : {&photo, &depth})
    DrawOutline(outline, first_px, static_cast<double>(times) / maps.cell_px, *picture);
  photo = WithFooter(photo, px_per_mm, "grey: nothing measured");
  depth = WithFooter(WithDepthBar(depth), px_per_mm, "depth below the virtual skin");
  const ImageRgb view =
      WithFooter(ViewOfWound(maps, colours), 0, "light blue: boundary; dark blue: virtual skin, lines 4 mm apart");
  std::vector<std::string> written;
  for (const auto& [name, picture] :
       {std::pair<const char*, const ImageRgb*>{"boundary.png", &photo}, {"depth.png", &depth}, {"view.png", &view}}) {
    const auto bytes = report::EncodePng(*picture);
    if (!bytes) return Fail(bytes.error());
    if (Status done = WriteFile(folder / name, *bytes); !done) return Fail(done.error());
    written.push_back((folder / name).string());
  }
  const fs::path sections = folder / "sections.svg";
  if (Status done = WriteText(sections, SvgFile(Sections(maps))); !done) return Fail(done.error());
  written.push_back(sections.string());
  return written;
}

Result<ImageRgb> PhotographOfSurface(const fs::path& path, const Surface& surface) {
  const auto bytes = ReadFile(path);
  if (!bytes) return Fail(bytes.error(), "reading the photograph");
  const auto made_from = PhotographOf(surface);
  if (made_from && *made_from != HashOf(*bytes)) {
    return Fail(ErrorCode::kUsage, path.string() + " is not the photograph that the surface was made from (" +
                                       made_from->ToString().substr(0, 12) + "...)");
  }
  auto photograph = DecodePhotograph(*bytes);
  if (!photograph) return Fail(photograph.error(), path.string());
  return std::move(photograph->colour);
}

ImageRgb OutlineOnPhotograph(const ImageRgb& photograph, const Outline& outline, double pixel_mm) {
  constexpr double kAround_mm = 12;
  Eigen::Vector2d low = outline.polygon_px.front(), high = low;
  for (const auto& p : outline.polygon_px) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const int around = static_cast<int>(std::lround(kAround_mm / pixel_mm));
  const int left = std::clamp(static_cast<int>(low.x()) - around, 0, photograph.width() - 1),
            top = std::clamp(static_cast<int>(low.y()) - around, 0, photograph.height() - 1),
            right = std::clamp(static_cast<int>(high.x()) + around, left, photograph.width() - 1),
            bottom = std::clamp(static_cast<int>(high.y()) + around, top, photograph.height() - 1);
  ImageRgb cut(right - left + 1, bottom - top + 1);
  for (int row = top; row <= bottom; ++row) {
    for (int col = left; col <= right; ++col) cut(col - left, row - top) = photograph(col, row);
  }
  const int times = EnlargementOf(cut);
  ImageRgb picture = Enlarged(cut, times);
  DrawOutline(outline, {left, top}, times, picture);
  return WithFooter(picture, times / pixel_mm, "the photograph, in sensor orientation");
}

}  // namespace striae::app
