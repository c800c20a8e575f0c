// A4 pages filled from top to bottom.
#pragma once

#include <string>

#include "report/detail/cairo_paint.h"

namespace striae::report::detail {

inline constexpr Rgb8 kInk{38, 50, 58}, kGrey{95, 110, 119}, kLineColour{225, 231, 234}, kSoft{245, 248, 249},
    kAccent{38, 103, 127}, kBad{178, 64, 44};

/// Points; the origin is the upper left corner of the page.
class Sheet {
 public:
  static constexpr double kWidth = 595.276, kHeight = 841.89;
  static constexpr double kLeft = 32, kRight = kWidth - 32, kTop = 27, kBottom = kHeight - 31;
  static constexpr double kContent = kRight - kLeft;

  /// `page_note` is printed at the foot of each page before "page i of n" (`pages` = 0: not known yet).
  Sheet(cairo_t* context, std::string page_note, int pages);

  [[nodiscard]] cairo_t* context() const { return context_; }
  [[nodiscard]] double y() const { return y_; }
  [[nodiscard]] double Room() const { return kBottom - y_; }
  [[nodiscard]] int page() const { return page_; }

  void Advance(double height) { y_ += height; }
  /// Starts the next page if less than `height` is left on this one.
  void Need(double height);
  /// Writes the last page's foot and ends it.
  void Finish();

  /// Height of wrapped markup without drawing it.
  double Measure(const std::string& markup, double size, double width) const;
  /// Draws wrapped markup with its upper left corner at (x, top); its height.
  double TextAt(double x, double top, const std::string& markup, double size, double width, Rgb8 colour = kInk) const;
  /// Draws at the cursor over the whole width and advances; breaks the page if it does not fit.
  void Paragraph(const std::string& markup, double size, Rgb8 colour, double space_after);
  void Rule(double top, Rgb8 colour, double width_pt) const;
  void Box(double x, double top, double width, double height, double radius, Rgb8 fill) const;

 private:
  void Foot() const;

  cairo_t* context_;
  std::string page_note_;
  int pages_ = 0, page_ = 1;
  double y_ = kTop;
};

}  // namespace striae::report::detail
