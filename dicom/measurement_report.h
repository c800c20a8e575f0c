// The numbers of a session as Comprehensive 3D SR, TID 1500 with one TID 1501 group an analysis.
#pragma once

#include <string>
#include <vector>

#include "core/measurement.h"
#include "core/result.h"
#include "core/time.h"
#include "dicom/object.h"
#include "dicom/session_context.h"

namespace striae::dicom {

/// One analysis of one capture, with the objects that it was made from.
struct MeasurementGroup {
  Capture capture;
  AnalysisReport report;
  UtcTime made_at;
  /// At least the photograph, which comes first; for a wound the surface, too. A neutral pose may be of an earlier
  /// session: it then stands in Pertinent Other Evidence.
  std::vector<ObjectReference> evidence;
};

/// Comprehensive 3D SR Storage (1.2.840.10008.5.1.4.1.1.88.34). Every number carries its standard uncertainty
/// (371884006 SCT, INFERRED FROM), its equivalents in other schemes (121050 DCM), the algorithm (111001, 111003 DCM)
/// and its sources (121112 DCM); a flagged one its reason as a comment (121106 DCM). The Tracking Unique Identifier is
/// the same at all visits of a subject for one wound label or for the head.
/// The content date is the latest made_at; the software version that of the first group's provenance.
/// kMeasurementRefused where CheckReport refuses a group; kUsage without groups.
Result<Object> EncodeMeasurements(const SessionContext& context, const std::vector<MeasurementGroup>& groups,
                                  int number);

}  // namespace striae::dicom
