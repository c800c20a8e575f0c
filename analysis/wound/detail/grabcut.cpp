#include "analysis/wound/detail/grabcut.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace striae::wound {
namespace {

cv::Mat3b ToMat(int width, int height, const std::vector<std::array<std::uint8_t, 3>>& cells) {
  cv::Mat3b mat(height, width);
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const auto& c =
          cells[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)];
      mat(j, i) = {c[0], c[1], c[2]};
    }
  }
  return mat;
}

std::uint8_t ToGrabCut(CellClass c) {
  switch (c) {
    case CellClass::kSkin:
      return cv::GC_BGD;
    case CellClass::kWound:
      return cv::GC_FGD;
    case CellClass::kProbablySkin:
      return cv::GC_PR_BGD;
    case CellClass::kProbablyWound:
      break;
  }
  return cv::GC_PR_FGD;
}

}  // namespace

Status CutOut(int width, int height, const std::vector<std::array<std::uint8_t, 3>>& features,
              std::vector<CellClass>& classes) {
  constexpr int kRounds = 6;
  try {
    cv::Mat1b mask(height, width);
    std::transform(classes.begin(), classes.end(), mask.begin(), ToGrabCut);
    cv::Mat skin, wound;
    cv::setRNGSeed(1);  // its clusters start at random
    cv::grabCut(ToMat(width, height, features), mask, cv::Rect(), skin, wound, kRounds, cv::GC_INIT_WITH_MASK);
    std::transform(mask.begin(), mask.end(), classes.begin(), [](std::uint8_t m) {
      return m == cv::GC_FGD || m == cv::GC_PR_FGD ? CellClass::kWound : CellClass::kSkin;
    });
  } catch (const cv::Exception& e) {
    return Fail(ErrorCode::kInternal, std::string("OpenCV could not part wound and skin: ") + e.what());
  }
  const auto inside = std::count(classes.begin(), classes.end(), CellClass::kWound);
  if (inside == 0 || inside == static_cast<std::ptrdiff_t>(classes.size())) {
    return Fail(
        ErrorCode::kMeasurementRefused,
        "nothing there differs from the skin around it; draw the outline by hand, or mark the wound by strokes");
  }
  return {};
}

std::vector<std::array<std::uint8_t, 3>> ToLab(const std::vector<std::array<std::uint8_t, 3>>& rgb) {
  if (rgb.empty()) return {};
  cv::Mat3b lab;
  cv::cvtColor(ToMat(static_cast<int>(rgb.size()), 1, rgb), lab, cv::COLOR_RGB2Lab);
  std::vector<std::array<std::uint8_t, 3>> out;
  for (const auto& c : lab) out.push_back({c[0], c[1], c[2]});
  return out;
}

std::vector<std::array<double, 2>> LongestBorder(int width, int height, const std::vector<std::uint8_t>& inside) {
  cv::Mat1b mask(height, width);
  std::copy(inside.begin(), inside.end(), mask.begin());
  const cv::Mat1b cross = cv::getStructuringElement(cv::MORPH_ELLIPSE, {5, 5});
  cv::morphologyEx(mask, mask, cv::MORPH_OPEN, cross);  // bridges and whiskers thinner than this are none of the wound
  cv::morphologyEx(mask, mask, cv::MORPH_CLOSE, cross);
  std::vector<std::vector<cv::Point>> lines;
  cv::findContours(mask, lines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  const auto longest = std::max_element(
      lines.begin(), lines.end(), [](const auto& a, const auto& b) { return cv::contourArea(a) < cv::contourArea(b); });
  std::vector<std::array<double, 2>> border;
  if (longest == lines.end()) return border;
  for (const cv::Point& p : *longest) border.push_back({static_cast<double>(p.x), static_cast<double>(p.y)});
  return border;
}

}  // namespace striae::wound
