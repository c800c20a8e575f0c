// Distinct id types (UUID version 4), so that a session can never be passed where a subject is meant.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/result.h"

namespace striae {

/// The 16 bytes of a UUID, without a meaning of their own.
struct Uuid {
  std::array<std::uint8_t, 16> bytes{};

  /// Version 4 from 16 random bytes (drawn in app/: nothing below it is random).
  static Uuid FromRandom(std::span<const std::uint8_t, 16> random);
  /// From the canonical 8-4-4-4-12 hexadecimal form; kBadFile otherwise.
  static Result<Uuid> Parse(std::string_view text);
  /// Lower case, 36 characters.
  [[nodiscard]] std::string ToString() const;

  auto operator<=>(const Uuid&) const = default;
};

template <typename Tag>
class Id {
 public:
  Id() = default;
  explicit Id(const Uuid& uuid) : uuid_(uuid) {}
  static Result<Id> Parse(std::string_view text) {
    auto uuid = Uuid::Parse(text);
    if (!uuid) return Fail(uuid.error());
    return Id(*uuid);
  }
  [[nodiscard]] const Uuid& uuid() const { return uuid_; }
  [[nodiscard]] std::string ToString() const { return uuid_.ToString(); }
  auto operator<=>(const Id&) const = default;

 private:
  Uuid uuid_;
};

using StudyId = Id<struct StudyTag>;
using SiteId = Id<struct SiteTag>;
using SubjectId = Id<struct SubjectTag>;
using VisitId = Id<struct VisitTag>;
using DeviceId = Id<struct DeviceTag>;
using CalibrationId = Id<struct CalibrationTag>;
using SessionId = Id<struct SessionTag>;
using CaptureId = Id<struct CaptureTag>;
using OutlineId = Id<struct OutlineTag>;
using SurfaceId = Id<struct SurfaceTag>;
using ReportId = Id<struct ReportTag>;
using MeasurementId = Id<struct MeasurementTag>;

}  // namespace striae
