#include "dicom/surface_model.h"

#include <cmath>
#include <cstdint>
#include <sstream>
#include <vector>

#include "core/ply.h"
#include "core/stl.h"
#include "dicom/body_site.h"
#include "dicom/detail/dataset.h"
#include "dicom/detail/encode.h"
#include "dicom/detail/modules.h"

namespace striae::dicom {
namespace {

using detail::DatasetWriter;

/// Rounded up to 0.01 mm: a stated deviation is never smaller than the true one.
std::string Millimetres(double value_mm) {
  const auto hundredths = static_cast<long>(std::ceil(100 * value_mm));
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << hundredths / 100 << '.' << (hundredths % 100) / 10 << hundredths % 10 << " mm";
  return text.str();
}

std::string Faithfulness(const ThinnedSurface& thinned) {
  if (thinned.step == 1) return "full resolution";
  const std::string step = std::to_string(thinned.step);
  return "1 pixel of " + step + "x" + step + ", deviation p95 " + Millimetres(thinned.deviation_p95_mm) + ", max " +
         Millimetres(thinned.deviation_max_mm);
}

void PutReferences(DatasetWriter& out, const ObjectReference& photo) {
  out.Item(DCM_SourceInstanceSequence, [&](DatasetWriter& item) { item.PutSopReference(photo); });
  out.Item(DCM_ReferencedSeriesSequence, [&](DatasetWriter& item) {
    item.Put(DCM_SeriesInstanceUID, photo.series_uid);
    item.Item(DCM_ReferencedInstanceSequence, [&](DatasetWriter& instance) { instance.PutSopReference(photo); });
  });
}

void PutDocument(DatasetWriter& out, const Capture& capture, const std::string& title) {
  out.Put(DCM_InstanceNumber, "1").Put(DCM_BurnedInAnnotation, "NO");
  out.PutDateTime(DCM_ContentDate, DCM_ContentTime, capture.imported_at);
  // The camera's own clock is not tied to UTC, so when exactly the light fell is not claimed.
  out.Put(DCM_AcquisitionDateTime, "");
  out.Put(DCM_RecognizableVisualFeatures, MayBeRecognizable(capture) ? "YES" : "NO");
  out.PutText(DCM_DocumentTitle, title, 1024);
  out.PutEmptySequence(DCM_ConceptNameCodeSequence);
  out.Put(DCM_MIMETypeOfEncapsulatedDocument, "model/stl");
}

void PutModel(DatasetWriter& out) {
  out.PutCode(DCM_MeasurementUnitsCodeSequence, {"UCUM", "mm", "mm"});
  out.Put(DCM_ModelModification, "NO").Put(DCM_ModelMirroring, "NO");
}

}  // namespace

Result<Object> EncodeSurface(const SessionContext& context, const Capture& capture, const ThinnedSurface& thinned,
                             const ObjectReference& photo, const std::string& software_version) {
  if (auto usable = detail::CheckContext(context); !usable) return Fail(usable.error());
  if (thinned.surface.faces.empty() || thinned.surface.faces.size() > kMostFaces) {
    return Fail(ErrorCode::kUsage,
                "a surface for DICOM has between 1 and " + std::to_string(kMostFaces) + " faces; thin it first");
  }
  if (photo.kind != ObjectKind::kPhoto || photo.study_uid != StudyUid(context)) {
    return Fail(ErrorCode::kUsage, "the surface refers to a photograph that is not of this session");
  }
  DcmFileFormat file;
  DatasetWriter out(*file.getDataset());
  // The deviation first: a Series Description has 64 characters, and a long label must not push it out.
  const std::string what = Faithfulness(thinned) + "; " + capture.role.ToString();
  detail::PutCommon(out, context, {SurfaceSeriesUid(context, capture.id), "M3D", 2, what},
                    detail::StriaeEquipment(context, software_version), UID_EncapsulatedSTLStorage);
  out.Put(DCM_FrameOfReferenceUID, FrameOfReferenceUid(context, capture.id)).Put(DCM_PositionReferenceIndicator, "");
  PutDocument(out, capture,
              "Surface in the camera frame (x right, y down, z forward), mm; " + what + "; left out at rims and cuts " +
                  detail::DecimalText(std::ceil(1000 * thinned.uncovered_share) / 10) + " % of the points");
  PutReferences(out, photo);
  PutModel(out);

  // The header is the same for every subject: nothing in it can identify anyone.
  std::vector<std::uint8_t> stl = EncodeStl(thinned.surface, "Striae surface, mm, camera frame");
  out.PutUint32(DCM_EncapsulatedDocumentLength, static_cast<std::uint32_t>(stl.size()));
  if (stl.size() % 2 != 0) stl.push_back(0);  // values of DICOM elements have an even length
  if (!out.status()) return Fail(out.status().error());
  const auto put = file.getDataset()->putAndInsertUint8Array(DCM_EncapsulatedDocument, stl.data(),
                                                             static_cast<unsigned long>(stl.size()));
  if (put.bad()) return Fail(ErrorCode::kInternal, std::string("cannot encapsulate the surface: ") + put.text());
  return detail::Finish(ObjectKind::kSurface, file, EXS_LittleEndianExplicit);
}

}  // namespace striae::dicom
