#include "reconstruct/white_balance.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "core/srgb.h"

namespace striae::reconstruct {
namespace {

struct Light {
  double r = 0, g = 0, b = 0;
  std::size_t count = 0;
};

double Rec709(const Light& light) { return 0.2126 * light.r + 0.7152 * light.g + 0.0722 * light.b; }

/// Mean light of the points that `chosen` takes.
template <typename Chosen>
Light MeanLight(const Surface& surface, const Chosen& chosen) {
  const std::array<double, 256> linear = LightOfBytes();
  Light mean;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (!chosen(i)) continue;
    const Rgb8 c = surface.colour[i];
    mean.r += linear[c.r];
    mean.g += linear[c.g];
    mean.b += linear[c.b];
    ++mean.count;
  }
  const double share = mean.count > 0 ? 1.0 / static_cast<double>(mean.count) : 0;
  return {mean.r * share, mean.g * share, mean.b * share, mean.count};
}

int Sum(const Rgb8& c) { return c.r + c.g + c.b; }

Light Reference(const WhiteBalance& balance, const Surface& surface) {
  if (balance.kind == WhiteBalance::Kind::kGreyWorld) return MeanLight(surface, [](std::size_t) { return true; });
  if (balance.kind == WhiteBalance::Kind::kGreyCard) {
    constexpr int kHalf_px = 20;
    return MeanLight(surface, [&](std::size_t i) {
      return surface.HasGrid() && std::abs(surface.col[i] - balance.col) <= kHalf_px &&
             std::abs(surface.row[i] - balance.row) <= kHalf_px;
    });
  }
  std::array<std::size_t, 766> histogram{};
  for (const Rgb8& c : surface.colour) ++histogram[static_cast<std::size_t>(Sum(c))];
  int level = 765;
  for (std::size_t above = 0; level > 0; --level) {
    above += histogram[static_cast<std::size_t>(level)];
    if (above * 100 >= surface.size()) break;
  }
  return MeanLight(surface, [&](std::size_t i) { return Sum(surface.colour[i]) >= level; });
}

std::array<std::uint8_t, 256> GainTable(double gain) {
  std::array<std::uint8_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double light = std::min(1.0, gain * LightFromSrgb(static_cast<double>(i) / 255));
    table[i] = static_cast<std::uint8_t>(std::lround(255 * SrgbFromLight(light)));
  }
  return table;
}

}  // namespace

Result<WhiteBalance> WhiteBalanceFrom(std::string_view text) {
  using Kind = WhiteBalance::Kind;
  if (text == "as-shot") return WhiteBalance{Kind::kAsShot};
  if (text == "grey-world") return WhiteBalance{Kind::kGreyWorld};
  if (text == "white-patch") return WhiteBalance{Kind::kWhitePatch};
  constexpr std::string_view kCard = "grey-card=";
  if (text.starts_with(kCard)) {
    WhiteBalance card{Kind::kGreyCard};
    const char *at = text.data() + kCard.size(), *end = text.data() + text.size();
    const auto col = std::from_chars(at, end, card.col);
    if (col.ec == std::errc{} && col.ptr != end && *col.ptr == ',') {
      const auto row = std::from_chars(col.ptr + 1, end, card.row);
      if (row.ec == std::errc{} && row.ptr == end) return card;
    }
  }
  return Fail(ErrorCode::kUsage, "white balance '" + std::string(text) +
                                     "' is not known; use as-shot, grey-world, white-patch or grey-card=COL,ROW");
}

Result<WhiteGains> Balance(const WhiteBalance& balance, Surface& surface) {
  if (balance.kind == WhiteBalance::Kind::kAsShot) return WhiteGains{};
  constexpr double kDarkest = 0.002, kLargest = 4;
  const Light light = Reference(balance, surface);
  if (light.count == 0) {
    return Fail(ErrorCode::kMeasurementRefused, "no point of the surface lies where the grey card should be (" +
                                                    std::to_string(balance.col) + ", " + std::to_string(balance.row) +
                                                    "); give a sensor pixel (column, row) on the card");
  }
  const double grey = Rec709(light), least = std::min({light.r, light.g, light.b});
  if (least < kDarkest || grey / least > kLargest) {
    return Fail(ErrorCode::kMeasurementRefused,
                "what should be grey is black or of a strong colour; give a pixel on the grey card, or use as-shot");
  }
  const WhiteGains gains{grey / light.r, grey / light.g, grey / light.b};
  const auto red = GainTable(gains.red), green = GainTable(gains.green), blue = GainTable(gains.blue);
  for (Rgb8& c : surface.colour) c = {red[c.r], green[c.g], blue[c.b]};
  return gains;
}

}  // namespace striae::reconstruct
