#include "dicom/photo.h"

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <dcmtk/config/osconfig.h>
// osconfig.h comes first: DCMTK's other headers need it.
#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>

#include "dicom/body_site.h"
#include "dicom/detail/dataset.h"
#include "dicom/detail/encode.h"
#include "dicom/detail/modules.h"
#include "dicom/jpeg.h"

namespace striae::dicom {
namespace {

using detail::DatasetWriter;

/// What stands in the camera's EXIF Orientation, in words; empty when the camera was held upright or did not say.
std::string TurnInWords(std::optional<int> orientation) {
  switch (orientation.value_or(1)) {
    case 3:
      return "Camera upside down: turn 180 degrees to view upright";
    case 6:
      return "Camera turned: rotate 90 degrees clockwise to view upright";
    case 8:
      return "Camera turned: rotate 90 degrees counter-clockwise to view upright";
    case 1:
      return "";
    default:
      return "Mirrored orientation in EXIF; pixels as the sensor read them";
  }
}

/// Patient Orientation (0020,0020) of a subject who faces the camera: where the rows, then where the columns lead.
/// Upright, the right edge of the picture is the subject's left.
std::string FacingOrientation(std::optional<int> orientation) {
  switch (orientation.value_or(1)) {
    case 1:
      return "L\\F";
    case 3:
      return "R\\H";
    case 6:
      return "F\\R";
    case 8:
      return "H\\L";
    default:
      return "";
  }
}

void PutPixelDescription(DatasetWriter& out, const JpegInfo& info, std::size_t jpeg_bytes) {
  const bool grey = info.colour == JpegInfo::Colour::kGrey;
  out.PutUint16(DCM_SamplesPerPixel, grey ? 1 : 3);
  // YBR_FULL_422 is the one YCbCr name that the IOD allows for JPEG; decoders take the sampling from the stream.
  out.Put(DCM_PhotometricInterpretation, grey ? "MONOCHROME2" : "YBR_FULL_422");
  if (!grey) out.PutUint16(DCM_PlanarConfiguration, 0);
  out.PutUint16(DCM_Rows, static_cast<std::uint16_t>(info.height_px));
  out.PutUint16(DCM_Columns, static_cast<std::uint16_t>(info.width_px));
  out.PutUint16(DCM_BitsAllocated, 8).PutUint16(DCM_BitsStored, 8).PutUint16(DCM_HighBit, 7);
  out.PutUint16(DCM_PixelRepresentation, 0);
  const double raw = (grey ? 1.0 : 3.0) * info.width_px * info.height_px;
  const double ratio = static_cast<double>(std::lround(100 * raw / static_cast<double>(jpeg_bytes))) / 100;
  out.Put(DCM_LossyImageCompression, "01").Put(DCM_LossyImageCompressionMethod, "ISO_10918_1");
  out.Put(DCM_LossyImageCompressionRatio, detail::DecimalText(ratio));
}

void PutImage(DatasetWriter& out, const Capture& capture, int number) {
  out.Put(DCM_ImageType, "ORIGINAL\\PRIMARY").Put(DCM_InstanceNumber, std::to_string(number));
  out.PutDateTime(DCM_ContentDate, DCM_ContentTime, capture.imported_at);
  out.Put(DCM_BurnedInAnnotation, "NO");
  out.Put(DCM_RecognizableVisualFeatures, MayBeRecognizable(capture) ? "YES" : "NO");
  const bool facing = capture.role.kind == CaptureRole::Kind::kNeutral || capture.role.kind == CaptureRole::Kind::kPose;
  out.Put(DCM_PatientOrientation, facing ? FacingOrientation(capture.metadata.orientation) : "");
  std::string comment = capture.role.ToString();
  if (const std::string turn = TurnInWords(capture.metadata.orientation); !turn.empty()) comment += "; " + turn;
  out.PutText(DCM_ImageComments, comment, 1024);
  out.PutEmptySequence(DCM_AcquisitionContextSequence);
}

void PutAnatomy(DatasetWriter& out, const Capture& capture) {
  const auto site = SiteOf(capture);
  Laterality laterality = capture.laterality;
  if (laterality == Laterality::kUnspecified && site && !site->paired) laterality = Laterality::kUnpaired;
  out.Put(DCM_ImageLaterality, std::string(ToString(laterality)));
  if (site) {
    out.PutCode(DCM_AnatomicRegionSequence, site->code);
  } else if (!capture.body_site.empty()) {
    out.PutCode(DCM_AnatomicRegionSequence,
                detail::LocalCode(detail::CleanText(capture.body_site, 16), capture.body_site));
    detail::PutLocalCodingScheme(out);
  }
}

/// Pixel Data as one fragment that holds exactly these bytes; an empty offset table comes first.
Status PutFrame(DcmDataset& dataset, std::span<const std::uint8_t> jpeg) {
  const auto failed = [](const OFCondition& condition) {
    return Fail(ErrorCode::kInternal, std::string("cannot encapsulate the photograph: ") + condition.text());
  };
  auto sequence = std::make_unique<DcmPixelSequence>(DcmTag(DCM_PixelData, EVR_OB));
  auto offsets = std::make_unique<DcmPixelItem>(DcmTag(DCM_Item, EVR_OB));
  if (const auto inserted = sequence->insert(offsets.get()); inserted.bad()) return failed(inserted);
  static_cast<void>(offsets.release());  // the sequence owns it now
  std::vector<std::uint8_t> copy(jpeg.begin(), jpeg.end());
  DcmOffsetList ends;
  const auto stored =
      sequence->storeCompressedFrame(ends, copy.data(), static_cast<Uint32>(copy.size()), 0 /* one fragment */);
  if (stored.bad()) return failed(stored);
  auto pixels = std::make_unique<DcmPixelData>(DCM_PixelData);
  pixels->putOriginalRepresentation(EXS_JPEGProcess1, nullptr, sequence.release());
  if (const auto inserted = dataset.insert(pixels.get(), OFTrue); inserted.bad()) return failed(inserted);
  static_cast<void>(pixels.release());  // the data set owns it now
  return {};
}

}  // namespace

Result<Object> EncodePhoto(const SessionContext& context, const Capture& capture, std::span<const std::uint8_t> jpeg,
                           int number) {
  if (auto usable = detail::CheckContext(context); !usable) return Fail(usable.error());
  const auto info = InspectJpeg(jpeg);
  if (!info) return Fail(info.error(), "photograph " + capture.file_name);
  std::vector<std::uint8_t> stripped;
  if (context.strip_jpeg_metadata) {
    auto pixels_only = StripJpegMetadata(jpeg);
    if (!pixels_only) return Fail(pixels_only.error(), "photograph " + capture.file_name);
    stripped = std::move(*pixels_only);
    jpeg = stripped;
  }

  DcmFileFormat file;
  DatasetWriter out(*file.getDataset());
  const detail::Equipment camera{capture.metadata.make.empty() ? "unknown" : capture.metadata.make,
                                 capture.metadata.model.empty() ? context.device.model : capture.metadata.model,
                                 context.device.serial, ""};
  detail::PutCommon(out, context, {PhotoSeriesUid(context), "XC", 1, "Photographs under flash-lit grating"}, camera,
                    UID_VLPhotographicImageStorage);
  PutImage(out, capture, number);
  PutAnatomy(out, capture);
  PutPixelDescription(out, *info, jpeg.size());
  if (!out.status()) return Fail(out.status().error());
  if (auto stored = PutFrame(*file.getDataset(), jpeg); !stored) return Fail(stored.error());
  return detail::Finish(ObjectKind::kPhoto, file, EXS_JPEGProcess1);
}

}  // namespace striae::dicom
