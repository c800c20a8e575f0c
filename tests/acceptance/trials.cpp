#include "tests/acceptance/trials.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <stdexcept>

#include <opencv2/imgcodecs.hpp>
#include <unistd.h>

#include "app/io/photograph.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/temp_dir.h"

namespace striae::testing {
namespace {

namespace fs = std::filesystem;

fs::path Program() { return fs::path(STRIAE_BINARY_DIR) / "striae"; }

template <typename Value>
Value Need(Result<Value> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return *std::move(result);
}

Ran Run(const std::vector<std::string>& arguments) {
  const Ran ran = RunProgram(Program(), arguments);
  if (ran.exit_code != 0) throw std::runtime_error(arguments[0] + " " + arguments[1] + ": " + ran.err);
  return ran;
}

fs::path FolderFor(const std::string& name, bool& keep) {
  const char* kept = std::getenv("STRIAE_TRIALS");
  keep = kept != nullptr;
  // Tests of the same rig run beside each other: each process has a folder of its own.
  const std::string own = "striae-trial-" + name + "-" + std::to_string(::getpid());
  const fs::path folder = keep ? fs::path(kept) / name : fs::temp_directory_path() / own;
  if (!keep) fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

}  // namespace

std::string NameOf(rig::Range range) { return range == rig::Range::kSmall ? "small" : "large"; }

Calibration UnknownRig(rig::Range range, std::uint32_t seed) {
  std::mt19937 engine(seed * 7919U + (range == rig::Range::kSmall ? 1U : 2U));
  const auto off = [&](double most) {  // uniform by the engine's bits alone: the same on every machine
    return most * (2.0 * static_cast<double>(engine()) / 4294967295.0 - 1);
  };
  const rig::RigNominal nominal = rig::DefaultRig(range);
  Calibration c = nominal.calibration;
  const double focal = 1 + off(0.01);
  c.camera.fx *= focal;
  c.camera.fy *= focal * (1 + off(0.001));
  c.camera.cx += off(25);
  c.camera.cy += off(25);
  c.camera.k1 += off(0.03);
  c.camera.k2 += off(0.03);
  c.camera.p1 += off(2e-4);
  c.camera.p2 += off(2e-4);
  ProjectorModel& p = c.projector;
  p.center_mm += Eigen::Vector3d(off(5), off(5), off(5));
  // Aimed by hand at the middle of the field: where the light goes follows the place.
  const double down = std::atan2(-p.center_mm.y(), nominal.distance_mm - p.center_mm.z());
  p.rotation_rodrigues = {down + off(0.0035), p.rotation_rodrigues.y() + off(0.0035),
                          p.rotation_rodrigues.z() + off(0.0035)};
  p.focal_stripes *= 1 + off(0.02);
  p.center_order += off(1.5);
  p.k1 += off(0.015);
  return c;
}

Trials::Trials(rig::Range range, std::uint32_t seed, double scale)
    : range_(range), scale_(scale), rig_(UnknownRig(range, seed)) {
  const std::string name = NameOf(range) + "-" + std::to_string(seed) + "-" + std::to_string(std::lround(1000 * scale));
  folder_ = FolderFor(name, keep_);
  const std::string text = ToJsonText(rig_);
  WriteBytes(folder_ / "true.json", {text.begin(), text.end()});
}

Trials::~Trials() {
  std::error_code ignored;
  if (!keep_) fs::remove_all(folder_, ignored);
}

fs::path Trials::Scene(const std::string& scene, const std::vector<std::string>& options) {
  std::string name = scene;
  for (const std::string& option : options)
    name += "_" + option.substr(std::min(option.find_first_not_of('-'), option.size() - 1));
  const fs::path folder = folder_ / name;
  if (fs::exists(folder / "truth.json")) return folder;  // written last
  std::vector<std::string> arguments = {"simulate", scene,          "--rig",   (folder_ / "true.json").string(),
                                        "--range",  NameOf(range_), "--scale", std::to_string(scale_),
                                        "--out",    folder.string()};
  arguments.insert(arguments.end(), options.begin(), options.end());
  Run(arguments);
  return folder;
}

Shot Trials::Read(const fs::path& folder, const std::string& name) {
  Shot shot;
  shot.photograph = Need(app::DecodePhotograph(ReadBytes(folder / (name + ".jpg"))));
  const cv::Mat depth = cv::imread((folder / (name + ".depth.tiff")).string(), cv::IMREAD_UNCHANGED);
  const cv::Mat lit = cv::imread((folder / (name + ".lit.png")).string(), cv::IMREAD_GRAYSCALE);
  if (depth.type() != CV_32F || lit.size() != depth.size()) throw std::runtime_error("no truth for " + name);
  shot.depth_mm = ImageF(depth.cols, depth.rows);
  shot.lit = Mask(depth.cols, depth.rows);
  for (int row = 0; row < depth.rows; ++row) {
    std::copy_n(depth.ptr<float>(row), depth.cols, shot.depth_mm.Row(row));
    std::transform(lit.ptr(row), lit.ptr(row) + depth.cols, shot.lit.Row(row),
                   [](std::uint8_t v) { return static_cast<std::uint8_t>(v != 0); });
  }
  return shot;
}

std::string Trials::Calibrate() {
  const fs::path report = folder_ / "own.report.json";
  const auto steps = small() ? std::vector<std::string>{"--steps", "9", "--step-mm", "25"}
                             : std::vector<std::string>{"--steps", "7", "--step-mm", "50"};
  const fs::path scene = Scene("steps", steps);
  return Run({"calibrate", "--reference", (scene / "reference.ply").string(), "--steps", (scene / "steps.csv").string(),
              "--stripes", small() ? "140" : "67", "--period-um", small() ? "48" : "97", "--distance-mm",
              small() ? "900" : "1850", "--out", calibration_file().string(), "--json"})
      .out;
}

Calibration Trials::Own() const { return Need(CalibrationFromJson(ReadText(calibration_file()))); }

std::vector<PointError> PointErrors(const Surface& surface, const ImageF& depth_mm) {
  std::vector<PointError> errors;
  errors.reserve(surface.size());
  const bool doubted = surface.uncertainty_mm.size() == surface.size();
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const float truth = depth_mm(surface.col[i], surface.row[i]);
    if (!std::isfinite(truth)) continue;
    errors.push_back({surface.point_in_camera[i].z() - truth, doubted ? surface.uncertainty_mm[i] : 0.0F,
                      surface.col[i], surface.row[i]});
  }
  return errors;
}

ErrorFigures FiguresOf(const std::vector<PointError>& errors) {
  ErrorFigures figures;
  figures.points = errors.size();
  if (errors.size() < 2) return figures;
  const double n = static_cast<double>(errors.size());
  std::vector<float> values, sizes;
  double squares = 0;
  for (const PointError& e : errors) {
    figures.mean += e.error_mm / n;
    values.push_back(e.error_mm);
    sizes.push_back(std::abs(e.error_mm));
  }
  for (const PointError& e : errors) squares += std::pow(e.error_mm - figures.mean, 2);
  figures.sd = std::sqrt(squares / (n - 1));
  const auto at = [](std::vector<float>& of, double share) {
    const auto place = of.begin() + static_cast<long>(share * static_cast<double>(of.size() - 1));
    std::nth_element(of.begin(), place, of.end());
    return static_cast<double>(*place);
  };
  figures.median = at(values, 0.5);
  figures.median_abs = at(sizes, 0.5);
  figures.p90_abs = at(sizes, 0.9);
  return figures;
}

double CoverageOf(const Surface& surface, const Mask& lit) {
  std::size_t covered = 0;
  for (std::size_t i = 0; i < surface.size(); ++i) covered += lit(surface.col[i], surface.row[i]);
  const auto all = std::count(lit.pixels().begin(), lit.pixels().end(), std::uint8_t{1});
  return all == 0 ? 0 : static_cast<double>(covered) / static_cast<double>(all);
}

}  // namespace striae::testing
