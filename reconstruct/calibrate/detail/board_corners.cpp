#include "reconstruct/calibrate/detail/board_corners.h"

#include <algorithm>
#include <cmath>

#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace striae::reconstruct::detail {
namespace {

constexpr int kDetectionSide_px = 2200;  ///< markers are found on a picture of about this size, corners on the full one

std::optional<int> DictionaryNumber(const std::string& name) {
  if (name == "DICT_4X4_50") return cv::aruco::DICT_4X4_50;
  if (name == "DICT_4X4_250") return cv::aruco::DICT_4X4_250;
  if (name == "DICT_4X4_1000") return cv::aruco::DICT_4X4_1000;
  if (name == "DICT_5X5_50") return cv::aruco::DICT_5X5_50;
  if (name == "DICT_5X5_100") return cv::aruco::DICT_5X5_100;
  return std::nullopt;
}

/// 8 bit, roughly as the eye sees it, full scale at the 99th percentile.
cv::Mat Grey(const ImageF& background) {
  std::vector<float> sample;
  for (std::size_t i = 0; i < background.size(); i += 101) sample.push_back(background.pixels()[i]);
  const auto at = sample.begin() + static_cast<long>(0.99 * static_cast<double>(sample.size() - 1));
  std::nth_element(sample.begin(), at, sample.end());
  const float full = std::max(1e-6F, *at);
  cv::Mat grey(background.height(), background.width(), CV_8U);
  for (int row = 0; row < background.height(); ++row) {
    auto* out = grey.ptr<std::uint8_t>(row);
    const float* in = background.Row(row);
    for (int col = 0; col < background.width(); ++col) {
      out[col] = static_cast<std::uint8_t>(std::lround(255 * std::sqrt(std::clamp(in[col] / full, 0.0F, 1.0F))));
    }
  }
  return grey;
}

std::vector<BoardCorner> Find(const cv::Mat& grey, const CharucoBoard& layout, int dictionary_number) {
  const auto dictionary = cv::aruco::getPredefinedDictionary(dictionary_number);
  const auto board = cv::aruco::CharucoBoard::create(layout.columns, layout.rows, static_cast<float>(layout.square_mm),
                                                     static_cast<float>(layout.marker_mm), dictionary);
  const double scale = std::min(1.0, static_cast<double>(kDetectionSide_px) / std::max(grey.cols, grey.rows));
  cv::Mat small;
  cv::resize(grey, small, {}, scale, scale, cv::INTER_AREA);
  std::vector<std::vector<cv::Point2f>> markers;
  std::vector<int> ids;
  auto settings = cv::aruco::DetectorParameters::create();
  // The flash falls off over the field: local thresholds from a few modules to a marker's width.
  settings->adaptiveThreshWinSizeMin = 15;
  settings->adaptiveThreshWinSizeMax = 95;
  settings->adaptiveThreshWinSizeStep = 20;
  cv::aruco::detectMarkers(small, dictionary, markers, ids, settings);
  if (ids.empty()) return {};
  std::vector<cv::Point2f> corners;
  std::vector<int> corner_ids;
  cv::aruco::interpolateCornersCharuco(markers, ids, small, board, corners, corner_ids);
  if (corners.empty()) return {};
  // On the full picture; the window stays within the white border around a marker.
  double marker_px = 0;
  for (const auto& m : markers) marker_px += cv::norm(m[0] - m[1]) / scale / static_cast<double>(markers.size());
  const double border_px = (layout.square_mm - layout.marker_mm) / 2 / layout.marker_mm * marker_px;
  const int window = std::clamp(static_cast<int>(0.9 * border_px), 3, 60);
  for (auto& corner : corners) {  // pixel centres are integers in both pictures
    corner.x = static_cast<float>((corner.x + 0.5) / scale - 0.5);
    corner.y = static_cast<float>((corner.y + 0.5) / scale - 0.5);
  }
  cv::cornerSubPix(grey, corners, {window, window}, {-1, -1},
                   {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 60, 1e-4});
  // Versions of OpenCV differ in whether their board's y grows upwards; marker 0 is in the printed board's upper row.
  const double height_mm = layout.rows * layout.square_mm;
  const bool upwards = static_cast<double>(board->objPoints[0][0].y) > height_mm / 2;
  std::vector<BoardCorner> found;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const cv::Point3f& at = board->chessboardCorners[static_cast<std::size_t>(corner_ids[i])];
    const auto x = static_cast<double>(at.x), y = static_cast<double>(at.y);
    found.push_back(
        {{static_cast<double>(corners[i].x), static_cast<double>(corners[i].y)}, {x, upwards ? height_mm - y : y}});
  }
  return found;
}

}  // namespace

Result<std::vector<BoardCorner>> FindBoardCorners(const ImageF& background, const CharucoBoard& board) {
  const auto dictionary = DictionaryNumber(board.dictionary);
  if (!dictionary) return Fail(ErrorCode::kUsage, "unknown marker dictionary " + board.dictionary);
  try {
    return Find(Grey(background), board, *dictionary);
  } catch (const cv::Exception& e) {
    return Fail(ErrorCode::kInternal, std::string("OpenCV could not look for the board: ") + e.what());
  }
}

Result<BoardPose> PoseFromCorners(const std::vector<BoardCorner>& corners, const CameraModel& c) {
  std::vector<cv::Point3d> on_board;
  std::vector<cv::Point2d> seen;
  for (const BoardCorner& corner : corners) {
    on_board.emplace_back(corner.on_board_mm.x(), corner.on_board_mm.y(), 0);
    seen.emplace_back(corner.pixel.x(), corner.pixel.y());
  }
  const cv::Matx33d matrix(c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
  try {
    cv::Mat rotation, translation;
    if (cv::solvePnP(on_board, seen, matrix, cv::noArray(), rotation, translation, false, cv::SOLVEPNP_IPPE)) {
      BoardPose pose;
      for (int i = 0; i < 3; ++i) {
        pose.values[i] = rotation.at<double>(i);
        pose.values[3 + i] = translation.at<double>(i);
      }
      return pose;
    }
  } catch (const cv::Exception&) {
  }
  return Fail(ErrorCode::kBadCalibration, "the board's corners do not lie on a plane");
}

}  // namespace striae::reconstruct::detail
