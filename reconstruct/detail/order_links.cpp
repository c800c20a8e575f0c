#include "reconstruct/detail/order_links.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "reconstruct/detail/order_lines.h"

namespace striae::reconstruct::detail {
namespace {

constexpr double kDark = 0.25;           ///< of the light of bright stripes on the darker side
constexpr double kMissing = 0.75;        ///< stripes by which the phase goes on in the dark: half a one is usual
constexpr std::size_t kFewestLines = 8;  ///< of the grid, a third of a stripe apart
constexpr double kFurthest = 5;          ///< stripes between sound cells of two parts that meet
constexpr double kNarrowest = 0.6, kWidest = 8;  ///< shadows, stripes
constexpr double kMostAlike = 0.6;               ///< share of lines with the same step
constexpr double kAmbient = 0.003;  ///< of the bright stripes: less is no surface in the shadow, but nothing

constexpr double kSeen = 4;  ///< noises by which a dim stripe stands out

struct Meeting {
  LitLines lines;
  std::vector<int> steps;
};

/// Linear light of 8-bit sRGB (IEC 61966-2-1).
std::array<double, 256> DecodedSrgb() {
  std::array<double, 256> decoded{};
  for (std::size_t i = 0; i < decoded.size(); ++i) {
    const double v = static_cast<double>(i) / 255;
    decoded[i] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  }
  return decoded;
}

class Reader {
 public:
  Reader(const Grid& grid, const Mask& sound, const Parts& parts, const PhaseResult& phase, const ImageRgb& picture,
         int away)
      : grid_(grid),
        sound_(sound),
        parts_(parts),
        unwrapped_(phase.unwrapped),
        picture_(picture),
        away_(away),
        period_(phase.carrier_period_px),
        horizontal_(phase.direction == StripeDirection::kHorizontal) {
    cell_ = (horizontal_ ? grid.cell_y : grid.cell_x) / period_;
    length_ = horizontal_ ? grid.height : grid.width;
    // The amplitude's noise is that of about a period's pixels (the Hann window's noise bandwidth); Light adds up three
    // pixels with weights of 4.
    light_noise_ = 0.86 * std::sqrt(period_) * phase.noise * 4 * std::sqrt(3.0);
  }

  Lighting Read() {
    const int lines = horizontal_ ? grid_.width : grid_.height;
    for (int line = 0; line < lines; ++line) ReadLine(line);
    for (auto& [pair, meeting] : meetings_) {
      if (const auto link = Judge(pair.first, pair.second, meeting)) lighting_.links.push_back(*link);
    }
    // A few dark lines among many lit ones are marks on the surface.
    std::erase_if(lighting_.gaps, [&](const Gap& gap) {
      return gap.from != gap.to && std::any_of(lighting_.links.begin(), lighting_.links.end(), [&](const Link& link) {
               return link.lines.Proven() && link.from == gap.from && link.to == gap.to;
             });
    });
    return std::move(lighting_);
  }

 private:
  template <typename T>
  [[nodiscard]] T At(const Image<T>& image, int line, int at) const {
    return horizontal_ ? image(line, at) : image(at, line);
  }

  void ReadLine(int line) {
    const int furthest = static_cast<int>(kFurthest / cell_),
              narrowest = static_cast<int>(std::ceil(kNarrowest / cell_));
    int last_sound = -1, last = -1;
    for (int k = 0; k < length_; ++k) {
      const int at = away_ > 0 ? k : length_ - 1 - k;
      const std::int32_t part = At(parts_.part, line, at);
      if (part == kNone) continue;
      if (last >= 0 && std::abs(at - last) > narrowest) ReadGap(line, last, at);
      last = at;
      if (At(sound_, line, at) == 0) continue;
      if (last_sound >= 0 && std::abs(at - last_sound) <= furthest) {
        const bool parted = At(parts_.part, line, last_sound) != part;
        if (parted || std::abs(at - last_sound) > narrowest) ReadMeeting(line, last_sound, at, parted);
      }
      last_sound = at;
    }
  }

  /// Between the last sound cell of one part and the first of another one of the same region, or across unsound ones.
  void ReadMeeting(int line, int from, int to, bool parted) {
    const std::int32_t a = At(parts_.part, line, from), b = At(parts_.part, line, to);
    if (parts_.parent[static_cast<std::size_t>(a)] != parts_.parent[static_cast<std::size_t>(b)]) return;
    const auto dark = LongestDark(line, std::min(from, to), std::max(from, to));
    const bool lit = dark && dark->Missing() <= 0;
    if (parted) {
      Meeting& meeting = meetings_[{a, b}];
      ++(lit ? meeting.lines.lit : meeting.lines.unlit);
    }
    if (dark && !lit && dark->light > kAmbient)
      lighting_.gaps.push_back({a, b, line, from, to, -away_ * dark->Missing()});
  }

  [[nodiscard]] bool InPicture(int pixel) const {
    return pixel >= 0 && pixel < (horizontal_ ? picture_.height() : picture_.width());
  }
  [[nodiscard]] int Middle(int line) const {
    const int size = horizontal_ ? grid_.cell_x : grid_.cell_y;
    return line * size + size / 2;
  }
  [[nodiscard]] double PhaseAt(int line, int pixel) const {
    return horizontal_ ? unwrapped_.phase(Middle(line), pixel) : unwrapped_.phase(pixel, Middle(line));
  }
  [[nodiscard]] std::int32_t SheetAt(int line, int pixel) const {
    return horizontal_ ? unwrapped_.region(Middle(line), pixel) : unwrapped_.region(pixel, Middle(line));
  }

  /// Linear light of the photograph (any unit) at one pixel of a line, over three along the stripes.
  [[nodiscard]] double Light(int line, int pixel) const {
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

  /// Light from cell `low` to cell `high` of a line and a stripe and a half beyond either.
  struct Profile {
    std::vector<double> light;
    int first = 0;          ///< pixel of the line
    int low = 0, high = 0;  ///< the two cells in it
  };
  [[nodiscard]] Profile LightBetween(int line, int low, int high) const {
    const int size = horizontal_ ? grid_.cell_y : grid_.cell_x, beyond = static_cast<int>(1.5 * period_),
              end = (horizontal_ ? picture_.height() : picture_.width()) - 1;
    const int first = std::max(0, low * size - beyond), last = std::min(end, (high + 1) * size - 1 + beyond);
    Profile profile{{}, first, low * size - first, (high + 1) * size - 1 - first};
    for (int pixel = first; pixel <= last; ++pixel) profile.light.push_back(Light(line, pixel));
    return profile;
  }
  [[nodiscard]] static double Brightest(const std::vector<double>& light, int first, int last) {
    first = std::max(first, 0);
    last = std::min(last, static_cast<int>(light.size()) - 1);
    return first > last ? 0 : *std::max_element(light.begin() + first, light.begin() + last + 1);
  }

  /// Relative order at a pixel of a line: the phase where there is one; elsewhere it goes on, straight, from the
  /// nearest pixels that have one on both sides, or from those on the side of `inwards` alone.
  [[nodiscard]] double OrderAt(int line, int pixel, int inwards) const {
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
  [[nodiscard]] double CleanOrderAt(int line, int pixel, int into) const {
    const int near = pixel + into * static_cast<int>(0.75 * period_), far = near + into * static_cast<int>(period_);
    if (!InPicture(near) || !InPicture(far)) return std::numeric_limits<double>::quiet_NaN();
    if (SheetAt(line, near) < 0 || SheetAt(line, far) != SheetAt(line, near))
      return std::numeric_limits<double>::quiet_NaN();
    const double at_near = PhaseAt(line, near), slope = (PhaseAt(line, far) - at_near) / (far - near);
    return (at_near + slope * (pixel - near)) / (2 * std::numbers::pi);
  }

  struct Dark {
    double orders = 0;   ///< by which the phase goes on across it, less the stripes in it
    double stripes = 0;  ///< its length over the carrier's period
    double light = 0;    ///< its mean, against the bright stripes beside it
    /// Whole stripes that are missing: between two bright ones half a stripe is dark anyway, and where the edge of a
    /// shadow cuts a bright one, nothing is.
    [[nodiscard]] int Missing() const { return static_cast<int>(std::floor(orders + 0.25)); }
  };

  /// Bright stripes in a dark stretch: a shaded wall's, or dark cloth's. Their middle is at a whole order; a sliver of
  /// a stripe that a shadow cuts is elsewhere.
  [[nodiscard]] int DimStripes(int line, const Profile& p, int first, int last) const {
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

  /// The dark stretch between two cells over which the phase goes on most. Between two bright stripes that is half a
  /// stripe, however steep or dark the surface; in the shadow of a step by k stripes no light falls over k more.
  [[nodiscard]] std::optional<Dark> LongestDark(int line, int low, int high) const {
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

  void ReadGap(int line, int last, int first) {
    if (std::abs(first - last) * cell_ > kWidest) return;
    const auto dark = LongestDark(line, std::min(last, first), std::max(last, first));
    if (!dark || dark->stripes < kNarrowest || dark->light < kAmbient) return;
    const std::int32_t a = At(parts_.part, line, last), b = At(parts_.part, line, first);
    // Going with the shadow the light sheet goes on where the phase skips what is missing.
    const int step = -away_ * dark->Missing();
    lighting_.gaps.push_back({a, b, line, last, first, step});
    if (a != b) meetings_[{a, b}].steps.push_back(step);
  }

  [[nodiscard]] static std::optional<Link> Judge(int from, int to, Meeting& meeting) {
    Link link{from, to};
    link.lines = meeting.lines;
    if (meeting.steps.size() >= kFewestLines) {
      link.step = MedianOf(meeting.steps);
      const auto alike = static_cast<double>(std::count(meeting.steps.begin(), meeting.steps.end(), link.step));
      link.alike = alike / static_cast<double>(meeting.steps.size());
      link.shadow = link.alike >= kMostAlike;
    }
    return link.lines.lit + link.lines.unlit > 0 || link.shadow ? std::optional(link) : std::nullopt;
  }

  const Grid& grid_;
  const Mask& sound_;
  const Parts& parts_;
  const Unwrapped& unwrapped_;
  const ImageRgb& picture_;
  std::array<double, 256> decoded_ = DecodedSrgb();
  int away_;
  double period_;
  bool horizontal_;
  double cell_ = 0;         ///< stripes
  double light_noise_ = 0;  ///< sd of Light
  int length_ = 0;
  std::map<std::pair<std::int32_t, std::int32_t>, Meeting> meetings_;
  Lighting lighting_;
};

}  // namespace

Lighting ReadLighting(const Grid& grid, const Mask& sound, const Parts& parts, const PhaseResult& phase,
                      const ImageRgb& picture, int away) {
  return Reader(grid, sound, parts, phase, picture, away).Read();
}

}  // namespace striae::reconstruct::detail
