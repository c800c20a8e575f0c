#include "reconstruct/detail/order_links.h"

#include <cmath>
#include <map>
#include <optional>

#include "reconstruct/detail/order_light.h"
#include "reconstruct/detail/order_lines.h"

namespace striae::reconstruct::detail {
namespace {

constexpr std::size_t kFewestLines = 8;          ///< of the grid, a third of a stripe apart
constexpr double kFurthest = 5;                  ///< stripes between sound cells of two parts that meet
constexpr double kNarrowest = 0.6, kWidest = 8;  ///< shadows, stripes
constexpr double kMostAlike = 0.6;               ///< share of lines with the same step
constexpr double kAmbient = 0.003;  ///< of the bright stripes: less is no surface in the shadow, but nothing

struct Meeting {
  LitLines lines;
  std::vector<int> steps;
};

class Reader {
 public:
  Reader(const Grid& grid, const Mask& sound, const Parts& parts, const PhaseResult& phase, const ImageRgb& picture,
         int away)
      : grid_(grid),
        sound_(sound),
        parts_(parts),
        light_(grid, phase, picture),
        away_(away),
        period_(phase.carrier_period_px),
        horizontal_(phase.direction == StripeDirection::kHorizontal) {
    cell_ = (horizontal_ ? grid.cell_y : grid.cell_x) / period_;
    length_ = horizontal_ ? grid.height : grid.width;
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
    const auto dark = light_.LongestDark(line, std::min(from, to), std::max(from, to));
    const bool lit = dark && dark->Missing() <= 0;
    if (parted) {
      Meeting& meeting = meetings_[{a, b}];
      ++(lit ? meeting.lines.lit : meeting.lines.unlit);
    }
    if (dark && !lit && dark->light > kAmbient)
      lighting_.gaps.push_back({a, b, line, from, to, -away_ * dark->Missing()});
  }

  void ReadGap(int line, int last, int first) {
    if (std::abs(first - last) * cell_ > kWidest) return;
    const auto dark = light_.LongestDark(line, std::min(last, first), std::max(last, first));
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
  LineLight light_;
  int away_;
  double period_;
  bool horizontal_;
  double cell_ = 0;  ///< stripes
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
