#include "dicom/session_context.h"

#include "dicom/uid.h"

namespace striae::dicom {
namespace {

std::string Within(const SessionContext& context, const std::string& what) {
  return context.session.id.ToString() + "/" + context.subject.id.ToString() + "/" + what;
}

}  // namespace

std::string StudyUid(const SessionContext& context) { return UidOfName(Within(context, "study")); }
std::string PhotoSeriesUid(const SessionContext& context) { return UidOfName(Within(context, "photographs")); }
std::string SurfaceSeriesUid(const SessionContext& context, const CaptureId& capture) {
  return UidOfName(Within(context, "surface/" + capture.ToString()));
}
std::string MeasurementSeriesUid(const SessionContext& context) { return UidOfName(Within(context, "measurements")); }
std::string FrameOfReferenceUid(const SessionContext& context, const CaptureId& capture) {
  return UidOfName(Within(context, "frame/" + capture.ToString()));
}

}  // namespace striae::dicom
