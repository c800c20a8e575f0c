#include "app/versions.h"

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <sodium.h>

#include "core/provenance.h"

namespace striae::app {
namespace {
std::string Dotted(int major, int minor, int patch) {
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
}
}  // namespace

std::string VersionText() {
  return "striae " + std::string(StriaeVersion()) + "\n  Eigen " +
         Dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION) + "\n  libsodium " +
         sodium_version_string() + "\n  CLI11 " + CLI11_VERSION + "\n  nlohmann-json " +
         Dotted(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH);
}

}  // namespace striae::app
