// Errors as values: Result<T> where data or hardware can be bad; programmer errors throw std::logic_error.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

namespace striae {

/// Stable reasons for a refusal. Names never change meaning; new ones are added at the end.
enum class ErrorCode {
  kUsage,                ///< the caller asked for something that cannot be meant (exit code 2)
  kNotFound,             ///< a file, id or entity that does not exist
  kIo,                   ///< reading or writing failed (disk full, permission)
  kBadImage,             ///< truncated, undecodable or unsupported photograph
  kNoCarrier,            ///< no stripes, or stripes that cannot be told apart
  kBadCalibration,       ///< calibration file that cannot be meant
  kCalibrationMismatch,  ///< photograph and calibration do not belong together
  kBadFile,              ///< any other input file that cannot be parsed
  kOutlineOffSurface,    ///< outline that does not lie on reconstructed skin
  kMeasurementRefused,   ///< the surface does not allow a trustworthy number
  kRecordRefused,        ///< the study record does not allow it (no consent, duplicate, unknown session ...)
  kRecordDamaged,        ///< the study record contradicts itself
  kDeviceFailed,         ///< camera absent, busy, refused or unplugged
  kNetworkFailed,        ///< PACS absent or refused
  kInternal,             ///< a library failed in a way that Striae did not foresee
};

/// The stable text of a code, e.g. "no-carrier".
std::string_view ToString(ErrorCode code);

/// What went wrong, where, and what to do about it.
struct Error {
  ErrorCode code = ErrorCode::kInternal;
  std::string message;               ///< what and what to do, for a person
  std::vector<std::string> context;  ///< outermost last, e.g. "reading calibration left.json"

  /// Adds where it happened and returns itself, so that a chain reads outwards.
  Error& Within(std::string where) &;
  Error Within(std::string where) &&;

  /// "outermost: ...: message", one line.
  [[nodiscard]] std::string Describe() const;
};

/// A value or the reason why there is none. Discarding it is a compiler warning.
template <typename T>
class [[nodiscard]] Result : public tl::expected<T, Error> {
 public:
  using tl::expected<T, Error>::expected;
  Result(tl::unexpected<Error> unexpected) : tl::expected<T, Error>(std::move(unexpected)) {}
};

/// `return Fail(ErrorCode::kNoCarrier, "...");` from any function that returns a Result.
[[nodiscard]] tl::unexpected<Error> Fail(ErrorCode code, std::string message);

/// Hands an error on with the place added: `return Fail(result.error(), "reading " + path);`
[[nodiscard]] tl::unexpected<Error> Fail(Error error, std::string where);
[[nodiscard]] tl::unexpected<Error> Fail(Error error);

/// A Result without a value.
using Status = Result<void>;

}  // namespace striae
