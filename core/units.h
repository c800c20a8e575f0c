// Units in types at public boundaries. Inside a function, plain doubles carry a suffix (_mm, _px, _rad).
#pragma once

#include <compare>
#include <numbers>

namespace striae {

namespace detail {
/// A physical quantity, stored in one base unit; arithmetic only within the quantity.
template <typename Tag>
class Quantity {
 public:
  constexpr Quantity() = default;
  constexpr Quantity(const Quantity&) = default;
  constexpr Quantity& operator=(const Quantity&) = default;
  constexpr Quantity operator+(Quantity other) const { return Quantity(base_ + other.base_); }
  constexpr Quantity operator-(Quantity other) const { return Quantity(base_ - other.base_); }
  constexpr Quantity operator*(double factor) const { return Quantity(base_ * factor); }
  constexpr double operator/(Quantity other) const { return base_ / other.base_; }
  constexpr auto operator<=>(const Quantity&) const = default;

 protected:
  constexpr explicit Quantity(double base) : base_(base) {}
  [[nodiscard]] constexpr double base() const { return base_; }

 private:
  double base_ = 0;
};
}  // namespace detail

/// Base unit mm.
class Length : public detail::Quantity<Length> {
 public:
  constexpr Length() = default;
  constexpr Length(const Quantity& quantity) : Quantity(quantity) {}
  static constexpr Length Millimetres(double value) { return Length(value); }
  static constexpr Length Metres(double value) { return Length(1000 * value); }
  [[nodiscard]] constexpr double mm() const { return base(); }

 private:
  constexpr explicit Length(double mm) : Quantity(mm) {}
};

/// Base unit mm2.
class Area : public detail::Quantity<Area> {
 public:
  constexpr Area() = default;
  constexpr Area(const Quantity& quantity) : Quantity(quantity) {}
  static constexpr Area SquareMillimetres(double value) { return Area(value); }
  [[nodiscard]] constexpr double mm2() const { return base(); }
  [[nodiscard]] constexpr double cm2() const { return base() / 100; }

 private:
  constexpr explicit Area(double mm2) : Quantity(mm2) {}
};

/// Base unit mm3.
class Volume : public detail::Quantity<Volume> {
 public:
  constexpr Volume() = default;
  constexpr Volume(const Quantity& quantity) : Quantity(quantity) {}
  static constexpr Volume CubicMillimetres(double value) { return Volume(value); }
  [[nodiscard]] constexpr double mm3() const { return base(); }
  [[nodiscard]] constexpr double millilitres() const { return base() / 1000; }

 private:
  constexpr explicit Volume(double mm3) : Quantity(mm3) {}
};

/// Base unit radian.
class Angle : public detail::Quantity<Angle> {
 public:
  constexpr Angle() = default;
  constexpr Angle(const Quantity& quantity) : Quantity(quantity) {}
  static constexpr Angle Radians(double value) { return Angle(value); }
  static constexpr Angle Degrees(double value) { return Angle(value * std::numbers::pi / 180); }
  [[nodiscard]] constexpr double rad() const { return base(); }
  [[nodiscard]] constexpr double deg() const { return base() * 180 / std::numbers::pi; }

 private:
  constexpr explicit Angle(double rad) : Quantity(rad) {}
};

}  // namespace striae
