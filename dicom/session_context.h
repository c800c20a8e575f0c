// What all objects of one session share: who (as a pseudonym), which study, which apparatus, when.
#pragma once

#include <string>

#include "core/study.h"

namespace striae::dicom {

/// One session becomes one DICOM study. Identity is the pseudonym only: no name, birth date or hospital number of a
/// person enters here.
struct SessionContext {
  Study study;
  Site site;
  Subject subject;
  Visit visit;
  Session session;
  Device device;  ///< serial may be empty: then objects say "unknown"

  /// True: metadata segments inside the camera's JPEG are left out, and the objects claim the Basic Application Level
  /// Confidentiality Profile (PS3.15 E) with full dates and device identity retained. False: the camera's bytes go out
  /// unchanged, and the objects only say how the pseudonym came about, because the JPEG's own metadata was not cleaned.
  bool strip_jpeg_metadata = false;
};

/// Study Instance UID of the session. It depends on session and subject: a session moved to another subject is another
/// DICOM study.
std::string StudyUid(const SessionContext& context);
/// Series of all photographs / of one capture's surface (a series has one frame of reference) / of all measurements.
std::string PhotoSeriesUid(const SessionContext& context);
std::string SurfaceSeriesUid(const SessionContext& context, const CaptureId& capture);
std::string MeasurementSeriesUid(const SessionContext& context);
/// The camera frame of that capture; no two captures share one, because they are not registered to each other.
std::string FrameOfReferenceUid(const SessionContext& context, const CaptureId& capture);

}  // namespace striae::dicom
