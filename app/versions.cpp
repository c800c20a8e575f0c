#include "app/versions.h"

#include <initializer_list>
#include <string_view>
#include <utility>

#include <CGAL/version.h>
#include <CGAL/version_macros.h>
#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <ceres/version.h>
#include <dcmtk/config/osconfig.h>
#include <embree3/rtcore_config.h>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <opencv2/core/version.hpp>
#include <pcl/pcl_config.h>
#include <sqlite3.h>

#include "core/provenance.h"

namespace striae::app {

std::string VersionText() {
  const std::pair<std::string_view, std::string> libraries[] = {
      {"Cairo", STRIAE_CAIRO_VERSION},
      {"Ceres Solver", CERES_VERSION_STRING},
      {"CGAL", CGAL_VERSION_STR},
      {"CLI11", CLI11_VERSION},
      {"DCMTK", PACKAGE_VERSION},
      {"Eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
      {"Embree", RTC_VERSION_STRING},
      {"Exiv2", STRIAE_EXIV2_VERSION},
      {"FFTW", STRIAE_FFTW_VERSION},
      {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
      {"libgphoto2", STRIAE_GPHOTO2_VERSION},
      {"libsodium", STRIAE_SODIUM_VERSION},
      {"nlohmann-json",
       fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
      {"OpenCV", CV_VERSION},
      {"PCL", PCL_VERSION_PRETTY},
      {"SQLite", SQLITE_VERSION}};
  std::string text = "striae " + std::string(StriaeVersion()) + ", built with";
  for (const auto& [name, version] : libraries) text += fmt::format("\n  {} {}", name, version);
  return text;
}

}  // namespace striae::app
