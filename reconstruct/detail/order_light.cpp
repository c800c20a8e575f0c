#include "reconstruct/detail/order_light.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "core/srgb.h"

namespace striae::reconstruct::detail {
namespace {

constexpr double kDark = 0.25;     ///< of the light of bright stripes on the darker side
constexpr double kMissing = 0.75;  ///< stripes by which the phase goes on in the dark: half a one is usual
constexpr double kSeen = 4;        ///< noises by which a dim stripe stands out

double Brightest(const std::vector<double>& light, int first, int last) {
  first = std::max(first, 0);
  last = std::min(last, static_cast<int>(light.size()) - 1);
  return first > last ? 0 : *std::max_element(light.begin() + first, light.begin() + last + 1);
}

}  // namespace

LineLight::LineLight(const Grid& grid, const PhaseResult& phase, const ImageRgb& picture)
    : grid_(grid),
      unwrapped_(phase.unwrapped),
      picture_(picture),
      decoded_(LightOfBytes()),
      period_(phase.carrier_period_px),
      horizontal_(phase.direction == StripeDirection::kHorizontal),
      // The amplitude's noise is that of about a period's pixels (the Hann window's noise bandwidth); Light adds up
      // three pixels with weights of 4.
      light_noise_(0.86 * std::sqrt(period_) * phase.noise * 4 * std::sqrt(3.0)) {}

bool LineLight::InPicture(int pixel) const {
  return pixel >= 0 && pixel < (horizontal_ ? picture_.height() : picture_.width());
}
int LineLight::Middle(int line) const {
  const int size = horizontal_ ? grid_.cell_x : grid_.cell_y;
  return line * size + size / 2;
}
double LineLight::PhaseAt(int line, int pixel) const {
  return horizontal_ ? unwrapped_.phase(Middle(line), pixel) : unwrapped_.phase(pixel, Middle(line));
}
std::int32_t LineLight::SheetAt(int line, int pixel) const {
  return horizontal_ ? unwrapped_.region(Middle(line), pixel) : unwrapped_.region(pixel, Middle(line));
}

/// Linear light of the photograph (any unit) at one pixel of a line, over three along the stripes.
double LineLight::Light(int line, int pixel) const {
  const auto linear = [&](int x, int y) {
    const Rgb8& c = picture_(x, y);
    return decoded_[c.r] + 2 * decoded_[c.g] + decoded_[c.b];
  };
  const int middle = Middle(line), end = (horizontal_ ? picture_.width() : picture_.height()) - 1;
  double sum = 0;
  for (int i = std::max(0, middle - 1); i <= std::min(end, middle + 1); ++i)
    sum += horizontal_ ? linear(i, pixel) : linear(pixel, i);
  return sum;
}

LineLight::Profile LineLight::LightBetween(int line, int low, int high) const {
  const int size = horizontal_ ? grid_.cell_y : grid_.cell_x, beyond = static_cast<int>(1.5 * period_),
            end = (horizontal_ ? picture_.height() : picture_.width()) - 1;
  const int first = std::max(0, low * size - beyond), last = std::min(end, (high + 1) * size - 1 + beyond);
  Profile profile{{}, first, low * size - first, (high + 1) * size - 1 - first};
  for (int pixel = first; pixel <= last; ++pixel) profile.light.push_back(Light(line, pixel));
  return profile;
}
/// Relative order at a pixel of a line: the phase where there is one; elsewhere it goes on, straight, from the
/// nearest pixels that have one on both sides, or from those on the side of `inwards` alone.
double LineLight::OrderAt(int line, int pixel, int inwards) const {
  const auto phase = [&](int at) { return PhaseAt(line, at) / (2 * std::numbers::pi); };
  if (const double here = phase(pixel); std::isfinite(here)) return here;
  const int furthest = static_cast<int>(4 * period_);
  const auto valid = [&](int from, int step) {
    for (int k = 0; k < furthest; ++k) {
      if (const int at = from + k * step; InPicture(at) && std::isfinite(phase(at))) return at;
    }
    return -1;
  };
  const int near = valid(pixel, inwards);
  if (near < 0) return std::numeric_limits<double>::quiet_NaN();
  if (const int other = valid(pixel, -inwards); other >= 0 && SheetAt(line, near) == SheetAt(line, other)) {
    const double share = static_cast<double>(pixel - near) / (other - near);
    return (1 - share) * phase(near) + share * phase(other);
  }
  const int deeper = near + inwards * static_cast<int>(period_);
  if (!InPicture(deeper) || SheetAt(line, deeper) != SheetAt(line, near)) return phase(near);
  return phase(near) + (phase(deeper) - phase(near)) * (pixel - near) / (deeper - near);
}

/// The order at the end of a dark stretch, carried on straight from beyond where the window mixes what lies on both
/// sides of it; `into` is +1 or -1, away from the dark. NaN where that is not of the same sheet.
double LineLight::CleanOrderAt(int line, int pixel, int into) const {
  const int near = pixel + into * static_cast<int>(0.75 * period_), far = near + into * static_cast<int>(period_);
  if (!InPicture(near) || !InPicture(far)) return std::numeric_limits<double>::quiet_NaN();
  if (SheetAt(line, near) < 0 || SheetAt(line, far) != SheetAt(line, near))
    return std::numeric_limits<double>::quiet_NaN();
  const double at_near = PhaseAt(line, near), slope = (PhaseAt(line, far) - at_near) / (far - near);
  return (at_near + slope * (pixel - near)) / (2 * std::numbers::pi);
}

/// Bright stripes in a dark stretch: a shaded wall's, or dark cloth's. Their middle is at a whole order; a sliver of
/// a stripe that a shadow cuts is elsewhere.
int LineLight::DimStripes(int line, const Profile& p, int first, int last) const {
  constexpr double kValley = 0.6, kMiddle = 0.2, kSlice = 0.3;
  const auto& light = p.light;
  const double seen = kSeen * light_noise_;
  const int margin = static_cast<int>(period_ / 8);
  int found = 0;
  double least = 1e9, most = 0;  // since the last valley, since the last peak
  bool rising = false;
  int top = 0, rose = 0;
  const double narrowest = kSlice * period_;
  for (int i = first + margin; i <= last - margin; ++i) {
    const double v = light[static_cast<std::size_t>(i)];
    if (!rising) {
      least = std::min(least, v);
      if (least < kValley * v && v - least > seen) rising = true, most = v, top = rose = i;
    } else {
      if (v > most) most = v, top = i;
      if (v >= kValley * most || most - v <= seen) continue;
      const double order = OrderAt(line, p.first + top, -1);
      found += i - rose >= narrowest && std::abs(order - std::round(order)) < kMiddle ? 1 : 0;
      rising = false;
      least = v;
    }
  }
  return found;
}

std::optional<Dark> LineLight::LongestDark(int line, int low, int high) const {
  const Profile p = LightBetween(line, low, high);
  const int size = static_cast<int>(p.light.size());
  const double sides = std::min(Brightest(p.light, 0, p.low), Brightest(p.light, p.high, size - 1));
  if (sides <= 0) return std::nullopt;
  Dark longest;
  const int from = std::max(1, p.low - static_cast<int>(0.75 * period_)),
            to = std::min(size - 2, p.high + static_cast<int>(0.75 * period_));
  for (int i = from; i <= to; ++i) {
    if (p.light[static_cast<std::size_t>(i)] >= kDark * sides) continue;
    int end = i;
    double sum = 0;
    for (; end <= to && p.light[static_cast<std::size_t>(end)] < kDark * sides; ++end)
      sum += p.light[static_cast<std::size_t>(end)];
    Dark dark;
    dark.orders = OrderAt(line, p.first + end, +1) - OrderAt(line, p.first + i - 1, -1);
    const double clean = CleanOrderAt(line, p.first + end, +1) - CleanOrderAt(line, p.first + i - 1, -1);
    if (clean > dark.orders && SheetAt(line, p.first + end + static_cast<int>(0.75 * period_)) ==
                                   SheetAt(line, p.first + i - 1 - static_cast<int>(0.75 * period_)))
      dark.orders = clean;
    dark.stripes = (end - i) / period_;
    dark.light = sum / (end - i) / sides;
    if (dark.orders >= kMissing) dark.orders -= DimStripes(line, p, i, end - 1);
    if (!std::isfinite(dark.orders)) return std::nullopt;
    if (longest.stripes == 0 || dark.orders > longest.orders) longest = dark;
    i = end;
  }
  return longest;
}

}  // namespace striae::reconstruct::detail
