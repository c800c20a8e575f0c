// A made-up session: a limb with a wound and a head pose, small enough to be encoded in milliseconds.
#pragma once

#include <cstdint>
#include <vector>

#include "core/measurement.h"
#include "core/surface.h"
#include "dicom/measurement_report.h"
#include "dicom/object.h"
#include "dicom/session_context.h"

namespace striae::dicom::testing {

enum class JpegKind { kGrey, kColour422, kColour420, kColour444, kRgb, kProgressive };
/// A small photograph as libjpeg writes it, with an EXIF segment (APP1) that holds `secret` and a comment.
std::vector<std::uint8_t> MakeJpeg(JpegKind kind, int width_px = 61, int height_px = 47,
                                   const std::string& secret = "");
/// What another decoder than DICOM's sees: interleaved samples.
std::vector<std::uint8_t> DecodeJpeg(const std::vector<std::uint8_t>& jpeg);

SessionContext MakeContext();
/// A wound on the left calf; a neutral head pose.
Capture MakeWoundCapture();
Capture MakeHeadCapture();

/// A sphere of this radius, 1000 mm before the camera, seen through a pinhole of 1 px per mm: one vertex a pixel.
/// Columns from `cut_col` on lie `step_mm` farther away and no face bridges the cut.
Surface MakeSphere(int width_px, int height_px, double radius_mm, int cut_col = -1, double step_mm = 0);

AnalysisReport MakeWoundReport();
AnalysisReport MakeHeadReport();

/// Photograph, surface and report of the wound, as an export makes them.
struct ThreeObjects {
  std::vector<std::uint8_t> jpeg;
  Object photo, surface, measurements;
  [[nodiscard]] std::vector<const Object*> All() const { return {&photo, &surface, &measurements}; }
};
ThreeObjects MakeObjects(const SessionContext& context = MakeContext());

}  // namespace striae::dicom::testing
