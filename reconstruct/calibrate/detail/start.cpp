#include "reconstruct/calibrate/detail/start.h"

#include <algorithm>

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "reconstruct/detail/parallel.h"

namespace striae::reconstruct::detail {
namespace {

constexpr double kSearchShare = 0.12;  // of the object's size, to either side
constexpr double kSearchStepShare = 0.02;
constexpr double kSearchRoll_deg = 16, kRollStep_deg = 4;

double FocusedFocalLength(double focal_mm, double distance_mm) { return focal_mm / (1 - focal_mm / distance_mm); }

Eigen::Matrix3d LookAt(const Eigen::Vector3d& from, const Eigen::Vector3d& target, const Eigen::Vector3d& across) {
  const Eigen::Vector3d z = (target - from).normalized();
  const Eigen::Vector3d y = (across - across.dot(z) * z).normalized();
  Eigen::Matrix3d rotation;
  rotation << y.cross(z).transpose(), y.transpose(), z.transpose();
  return rotation;
}

/// Removes the best quadratic in the pixel from a signal sampled at the pixels.
class QuadraticRemover {
 public:
  QuadraticRemover(const std::vector<OrderSample>& samples, double scale) {
    Eigen::MatrixXd basis(samples.size(), 6);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Eigen::Vector2d p = samples[i].pixel / scale;
      basis.row(static_cast<Eigen::Index>(i)) << 1, p.x(), p.y(), p.x() * p.x(), p.x() * p.y(), p.y() * p.y();
    }
    q_ = Eigen::HouseholderQR<Eigen::MatrixXd>(basis).householderQ() * Eigen::MatrixXd::Identity(basis.rows(), 6);
  }
  [[nodiscard]] Eigen::VectorXd operator()(const Eigen::VectorXd& signal) const {
    return signal - q_ * (q_.transpose() * signal);
  }

 private:
  Eigen::MatrixXd q_;
};

}  // namespace

RigParameters NominalRigParameters(const NominalRig& nominal) {
  RigParameters p;
  const double distance = nominal.first_distance_mm;
  p.camera[0] = FocusedFocalLength(nominal.camera_focal_mm, distance) / nominal.pixel_pitch_mm;
  p.camera[1] = 1;
  p.camera[2] = (nominal.image_width_px - 1) / 2.0;
  p.camera[3] = (nominal.image_height_px - 1) / 2.0;
  const bool horizontal = nominal.direction == StripeDirection::kHorizontal;
  const Eigen::Vector3d center =
      horizontal ? nominal.projector_center_mm
                 : Eigen::Vector3d(nominal.projector_center_mm.y(), 0, nominal.projector_center_mm.z());
  const Eigen::Vector3d across = horizontal ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX();
  const Eigen::AngleAxisd rotation(LookAt(center, {0, 0, distance}, across));
  Eigen::Map<Eigen::Vector3d>{p.projector} = center;
  Eigen::Map<Eigen::Vector3d>{p.projector + 3} = rotation.angle() * rotation.axis();
  p.projector[6] = nominal.projector_focal_mm / nominal.grating_period_mm;
  p.projector[7] = nominal.stripes ? (*nominal.stripes - 1) / 2.0 : 0;
  return p;
}

RigParameters NominalParameters(const NominalRig& nominal, const ReferenceShape& shape) {
  RigParameters p = NominalRigParameters(nominal);
  const Eigen::Vector3d middle = (shape.lowest() + shape.highest()) / 2;
  Eigen::Map<Eigen::Vector3d>{p.pose + 3} =
      Eigen::Vector3d(-middle.x(), -middle.y(), nominal.first_distance_mm - middle.z());
  return p;
}

double FindObject(const ReferenceShape& shape, const CalibrationView& view, RigParameters& parameters,
                  std::size_t most_samples) {
  const std::size_t every = std::max<std::size_t>(1, view.samples.size() / most_samples);
  std::vector<OrderSample> samples;
  for (std::size_t i = 0; i < view.samples.size(); i += every) samples.push_back(view.samples[i]);
  const QuadraticRemover remove(samples, parameters.camera[2]);
  const auto count = static_cast<Eigen::Index>(samples.size());
  Eigen::VectorXd measured(count);
  for (Eigen::Index i = 0; i < count; ++i) measured[i] = samples[static_cast<std::size_t>(i)].order;
  measured = remove(measured).normalized();

  const double size_mm = (shape.highest() - shape.lowest()).head<2>().maxCoeff();
  const double reach = kSearchShare * size_mm, step = kSearchStepShare * size_mm;
  std::vector<RigParameters> trials;
  for (double roll_deg = -kSearchRoll_deg; roll_deg <= kSearchRoll_deg; roll_deg += kRollStep_deg) {
    for (double dx = -reach; dx <= reach; dx += step) {
      for (double dy = -reach; dy <= reach; dy += step) {
        trials.push_back(parameters);
        trials.back().pose[2] = roll_deg * M_PI / 180;
        trials.back().pose[3] += dx;
        trials.back().pose[4] += dy;
      }
    }
  }
  std::vector<double> scores(trials.size());
  ParallelLines(static_cast<int>(trials.size()), [&](int t) {
    const RigParameters& trial = trials[static_cast<std::size_t>(t)];
    const RayOnReference<double> reference(shape, trial.pose, trial.slide);
    Eigen::VectorXd predicted(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      double point[3];
      reference(trial.camera, samples[static_cast<std::size_t>(i)].pixel, view.position_mm, point);
      predicted[i] = OrderOf({}, trial.projector, point);
    }
    scores[static_cast<std::size_t>(t)] = remove(predicted).normalized().dot(measured);
  });
  const auto best = std::max_element(scores.begin(), scores.end());
  parameters = trials[static_cast<std::size_t>(best - scores.begin())];
  return *best;
}

RigParameters AngularFrom(const RigParameters& pinhole, int axis) {
  RigParameters angular = pinhole;
  const Eigen::Vector3d straight =
      RotationFromRodrigues(Eigen::Map<const Eigen::Vector3d>(pinhole.projector + 3)).transpose() *
      Eigen::Vector3d::UnitZ();
  angular.projector[7] = pinhole.projector[7] - pinhole.projector[6] * std::atan(straight[axis] / straight.z());
  for (const int i : {3, 4, 5, 8}) angular.projector[i] = 0;
  return angular;
}

}  // namespace striae::reconstruct::detail
