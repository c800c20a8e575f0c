#include "analysis/wound/detail/skin.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace striae::wound {
namespace {

constexpr double kMadToSd = 1.4826;
constexpr double kHuber = 1.345, kTukey = 4.685;  // the usual 95 % efficient tuning
constexpr double kIndependentPatch =
    0.1;  // residuals of real surfaces correlate over about a tenth of the ring's radius

void Monomials(double u, double v, int order, Eigen::VectorXd& out) {
  out.resize((order + 1) * (order + 2) / 2);
  Eigen::Index k = 0;
  double pu = 1;
  for (int i = 0; i <= order; ++i, pu *= u) {
    double p = pu;
    for (int j = 0; i + j <= order; ++j, p *= v) out[k++] = p;
  }
}

double RadiusOf(const std::vector<Eigen::Vector3d>& ring) {
  double sum = 0;
  for (const auto& p : ring) sum += p.head<2>().squaredNorm();
  return std::sqrt(sum / static_cast<double>(ring.size()));
}

double MedianAbs(std::vector<double> values) {
  for (double& v : values) v = std::abs(v);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct LinearFit {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd inverse_normal;
};

LinearFit FitPolynomial(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights, int order) {
  const Eigen::Index n = (order + 1) * (order + 2) / 2;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n), terms;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (weights[k] <= 0) continue;
    Monomials(points[k].x(), points[k].y(), order, terms);
    normal.selfadjointView<Eigen::Lower>().rankUpdate(terms, weights[k]);
    right += weights[k] * points[k].z() * terms;
  }
  normal.diagonal().array() += 1e-12 * normal.trace();
  const auto factor = normal.selfadjointView<Eigen::Lower>().ldlt();
  return {factor.solve(right), factor.solve(Eigen::MatrixXd::Identity(n, n))};
}

std::vector<Eigen::Vector3d> Scaled(const std::vector<Eigen::Vector3d>& points, double factor) {
  std::vector<Eigen::Vector3d> scaled(points.size());
  std::transform(points.begin(), points.end(), scaled.begin(),
                 [&](const auto& p) { return Eigen::Vector3d(p * factor); });
  return scaled;
}

}  // namespace

std::string_view ToString(SkinModel model) {
  switch (model) {
    case SkinModel::kC2:
      return "c2";
    case SkinModel::kC4:
      return "c4";
    case SkinModel::kQuadric:
      return "q";
    case SkinModel::kQuadricC4:
      return "q+c4";
    case SkinModel::kQuadricSpline:
      return "q+s";
    case SkinModel::kFaired:
      return "q+s+f";
  }
  return "";
}

Frame FitFrame(const std::vector<Eigen::Vector3d>& points_in_camera) {
  Frame frame;
  std::vector<std::uint8_t> keep(points_in_camera.size(), 1);
  for (int round = 0; round < 3; ++round) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double count = 0;
    for (std::size_t k = 0; k < points_in_camera.size(); ++k) {
      if (keep[k] == 0) continue;
      mean += points_in_camera[k];
      ++count;
    }
    mean /= count;
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < points_in_camera.size(); ++k) {
      const Eigen::Vector3d d = points_in_camera[k] - mean;
      if (keep[k] != 0) scatter += d * d.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
    Eigen::Vector3d w = eigen.eigenvectors().col(0);
    if (w.dot(mean) > 0) w = -w;  // towards the camera
    const Eigen::Vector3d u = eigen.eigenvectors().col(2);
    frame.origin = mean;
    frame.wound_from_camera << u.transpose(), w.cross(u).transpose(), w.transpose();

    std::vector<double> distance(points_in_camera.size());
    for (std::size_t k = 0; k < distance.size(); ++k) distance[k] = frame.FromCamera(points_in_camera[k]).z();
    const double limit = 4 * kMadToSd * MedianAbs(distance);  // a limb's own curvature stays within
    for (std::size_t k = 0; k < distance.size(); ++k) keep[k] = std::abs(distance[k]) <= limit ? 1 : 0;
  }
  return frame;
}

Eigen::VectorXd Skin::Terms(double u, double v) const {
  Eigen::VectorXd terms;
  Monomials(u / radius_mm, v / radius_mm, order, terms);
  return terms;
}

double Skin::Height(double u, double v) const {
  u /= radius_mm;
  v /= radius_mm;
  double w = quadric ? quadric->At(u, v).value_or(0) : 0;
  Eigen::Index k = 0;
  double pu = 1;
  for (int i = 0; i <= order; ++i, pu *= u) {
    double p = pu;
    for (int j = 0; i + j <= order; ++j, p *= v) w += coefficients[k++] * p;
  }
  if (spline) w += spline->At(u, v);
  if (faired) w += faired->At(u, v);
  return w * radius_mm;
}

Eigen::Vector2d Skin::Gradient(double u, double v) const {
  const double h = 1e-4 * radius_mm;
  return {(Height(u + h, v) - Height(u - h, v)) / (2 * h), (Height(u, v + h) - Height(u, v - h)) / (2 * h)};
}

RingWeights WeighRing(const std::vector<Eigen::Vector3d>& ring) {
  const double radius = RadiusOf(ring);
  const auto points = Scaled(ring, 1 / radius);
  RingWeights result;
  result.weight.assign(points.size(), 1);
  std::vector<double> residual(points.size());
  Eigen::VectorXd terms;
  for (int round = 0; round < 7; ++round) {
    const LinearFit fit = FitPolynomial(points, result.weight, 4);
    for (std::size_t k = 0; k < points.size(); ++k) {
      Monomials(points[k].x(), points[k].y(), 4, terms);
      residual[k] = points[k].z() - terms.dot(fit.coefficients);
    }
    const double sd = std::max(kMadToSd * MedianAbs(residual), 1e-7);
    result.noise_mm = sd * radius;
    double left_out = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double r = std::abs(residual[k]) / sd;
      if (round < 3) {
        result.weight[k] = r <= kHuber ? 1 : kHuber / r;
      } else {
        const double t = r / kTukey;
        result.weight[k] = t < 1 ? (1 - t * t) * (1 - t * t) : 0;
        if (t >= 1) ++left_out;
      }
    }
    result.outlier_share = left_out / static_cast<double>(points.size());
  }
  return result;
}

Skin FitSkin(SkinModel model, const std::vector<Eigen::Vector3d>& ring, const RingWeights& weights) {
  Skin skin;
  skin.model = model;
  skin.radius_mm = RadiusOf(ring);
  const bool splined = model == SkinModel::kQuadricSpline || model == SkinModel::kFaired;
  const bool stiff = model != SkinModel::kC4 && model != SkinModel::kQuadricC4;
  skin.order = stiff ? 2 : 4;  // a quadratic on a quadric's residual only rounds it off
  auto points = Scaled(ring, 1 / skin.radius_mm);
  if (model != SkinModel::kC2 && model != SkinModel::kC4) {
    // The ring has about 2 pi R times its width; a third of its radius is a fair width for counting patches.
    const double independent = 2.0 / (kIndependentPatch * kIndependentPatch);
    skin.quadric = FitQuadric(points, weights.weight, weights.noise_mm / skin.radius_mm, independent);
    // The quadric must have a sheet across the wound, not only over the ring.
    const std::size_t stride = std::max<std::size_t>(1, points.size() / 100);
    for (std::size_t k = 0; k < points.size() && skin.quadric; k += stride) {
      for (double inwards = 0; inwards < 1 && skin.quadric; inwards += 0.25) {
        if (!skin.quadric->At(inwards * points[k].x(), inwards * points[k].y())) skin.quadric.reset();
      }
    }
    if (skin.quadric) {
      for (auto& p : points) p.z() -= skin.quadric->At(p.x(), p.y()).value_or(0);
    } else {
      if (!splined) skin.model = stiff ? SkinModel::kC2 : SkinModel::kC4;
      skin.fell_back = true;
    }
  }
  LinearFit fit = FitPolynomial(points, weights.weight, skin.order);
  for (std::size_t k = 0; k < points.size(); ++k) {
    Eigen::VectorXd terms;
    Monomials(points[k].x(), points[k].y(), skin.order, terms);
    points[k].z() -= terms.dot(fit.coefficients);
  }
  if (splined) skin.spline = FitSpline(points, weights.weight);
  double sum = 0, total = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double r = points[k].z() - (skin.spline ? skin.spline->At(points[k].x(), points[k].y()) : 0);
    sum += weights.weight[k] * r * r;
    total += weights.weight[k];
  }
  skin.rms_mm = std::sqrt(sum / std::max(total, 1e-9)) * skin.radius_mm;
  skin.coefficients = std::move(fit.coefficients);
  skin.inverse_normal = std::move(fit.inverse_normal);
  if (model == SkinModel::kFaired && !skin.fell_back) {
    const double r = skin.radius_mm;
    skin.faired = FairAcross(points, weights.weight, [&](double u, double v) { return skin.Height(u * r, v * r) / r; });
    skin.fell_back = !skin.faired;
  }
  return skin;
}

}  // namespace striae::wound
