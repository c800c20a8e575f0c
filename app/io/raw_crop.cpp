#include <algorithm>
#include <cmath>
#include <vector>

#include "app/io/raw.h"

namespace striae::app {
namespace {

/// Differences over two pixels: what correlates between a raw picture and a sharpened JPEG of it.
struct Gradient {
  float x = 0, y = 0;
};
Gradient GradientAt(const ImageF& image, int col, int row) {
  return {image(col + 1, row) - image(col - 1, row), image(col, row + 1) - image(col, row - 1)};
}

struct Place {
  int col = 0, row = 0;
  Gradient gradient;
};

/// The steepest pixel of every tile: some ten thousand places all over the picture.
std::vector<Place> SteepPlaces(const ImageF& image) {
  const int tile = std::max(4, static_cast<int>(std::sqrt(static_cast<double>(image.size()) / 10'000)));
  std::vector<Place> places;
  for (int top = 1; top + tile < image.height(); top += tile) {
    for (int left = 1; left + tile < image.width(); left += tile) {
      Place best;
      float steepest = 0;
      for (int row = top; row < top + tile; row += 2) {
        for (int col = left; col < left + tile; ++col) {
          const Gradient g = GradientAt(image, col, row);
          const float steepness = g.x * g.x + g.y * g.y;
          if (steepness <= steepest) continue;
          steepest = steepness;
          best = {col, row, g};
        }
      }
      if (steepest > 0) places.push_back(best);
    }
  }
  return places;
}

double Correlation(const ImageF& whole, const std::vector<Place>& places, Offset at) {
  double both = 0, one = 0, other = 0;
  for (const Place& place : places) {
    const Gradient g = GradientAt(whole, place.col + at.col, place.row + at.row);
    both += g.x * place.gradient.x + g.y * place.gradient.y;
    one += g.x * g.x + g.y * g.y;
    other += place.gradient.x * place.gradient.x + place.gradient.y * place.gradient.y;
  }
  return both / std::sqrt(std::max(one * other, 1e-30));
}

}  // namespace

bool FindPart(const ImageF& whole, const ImageF& part, Offset& offset) {
  constexpr int kWidestMargin = 128;
  constexpr double kFits = 0.5;  // the same picture gives 0.8 and more, a place one pixel off less
  const int most_col = whole.width() - part.width(), most_row = whole.height() - part.height();
  if (most_col < 0 || most_row < 0 || most_col > kWidestMargin || most_row > kWidestMargin) return false;
  const std::vector<Place> places = SteepPlaces(part);
  if (places.size() < 20) return false;
  double best = 0;
  for (int row = 0; row <= most_row; ++row) {
    for (int col = 0; col <= most_col; ++col) {
      const double correlation = Correlation(whole, places, {col, row});
      if (correlation <= best) continue;
      best = correlation;
      offset = {col, row};
    }
  }
  return best > kFits;
}

}  // namespace striae::app
