#include "report/print/detail/marker.h"

#include <opencv2/aruco.hpp>

#include "core/target.h"

namespace striae::report::detail {

Result<Mask> MarkerModules(const std::string& dictionary, int marker_id) {
  const bool label = dictionary == kLabelDictionary;
  if (!label && dictionary != kBoardDictionary) {
    return Fail(ErrorCode::kUsage, "marker dictionary '" + dictionary + "' is not known; use " +
                                       std::string(kBoardDictionary) + " or " + std::string(kLabelDictionary));
  }
  try {
    const auto markers = cv::aruco::getPredefinedDictionary(label ? cv::aruco::DICT_4X4_1000 : cv::aruco::DICT_5X5_50);
    if (marker_id < 0 || marker_id >= markers->bytesList.rows) {
      return Fail(ErrorCode::kUsage, dictionary + " has markers 0 to " + std::to_string(markers->bytesList.rows - 1) +
                                         ", not " + std::to_string(marker_id));
    }
    const int modules = markers->markerSize + 2;
    cv::Mat1b picture;
    cv::aruco::drawMarker(markers, marker_id, modules, picture, 1);
    Mask black(modules, modules);
    for (int y = 0; y < modules; ++y) {
      for (int x = 0; x < modules; ++x) black(x, y) = picture(y, x) == 0 ? 1 : 0;
    }
    return black;
  } catch (const cv::Exception& error) {
    return Fail(ErrorCode::kInternal, std::string("the marker could not be drawn: ") + error.what());
  }
}

}  // namespace striae::report::detail
