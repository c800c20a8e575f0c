#include "core/result.h"

namespace striae {

std::string_view ToString(ErrorCode code) {
  switch (code) {
    case ErrorCode::kUsage:
      return "usage";
    case ErrorCode::kNotFound:
      return "not-found";
    case ErrorCode::kIo:
      return "io";
    case ErrorCode::kBadImage:
      return "bad-image";
    case ErrorCode::kNoCarrier:
      return "no-carrier";
    case ErrorCode::kBadCalibration:
      return "bad-calibration";
    case ErrorCode::kCalibrationMismatch:
      return "calibration-mismatch";
    case ErrorCode::kBadFile:
      return "bad-file";
    case ErrorCode::kOutlineOffSurface:
      return "outline-off-surface";
    case ErrorCode::kMeasurementRefused:
      return "measurement-refused";
    case ErrorCode::kRecordRefused:
      return "record-refused";
    case ErrorCode::kRecordDamaged:
      return "record-damaged";
    case ErrorCode::kDeviceFailed:
      return "device-failed";
    case ErrorCode::kNetworkFailed:
      return "network-failed";
    case ErrorCode::kInternal:
      return "internal";
  }
  return "internal";
}

Error& Error::Within(std::string where) & {
  context.push_back(std::move(where));
  return *this;
}

Error Error::Within(std::string where) && {
  context.push_back(std::move(where));
  return std::move(*this);
}

std::string Error::Describe() const {
  std::string text;
  for (auto it = context.rbegin(); it != context.rend(); ++it) text += *it + ": ";
  return text + message;
}

tl::unexpected<Error> Fail(ErrorCode code, std::string message) {
  return tl::unexpected<Error>(Error{code, std::move(message), {}});
}

tl::unexpected<Error> Fail(Error error, std::string where) {
  return tl::unexpected<Error>(std::move(error).Within(std::move(where)));
}

tl::unexpected<Error> Fail(Error error) { return tl::unexpected<Error>(std::move(error)); }

}  // namespace striae
