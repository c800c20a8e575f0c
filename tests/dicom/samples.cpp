#include "tests/dicom/samples.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <jpeglib.h>

#include "dicom/photo.h"
#include "dicom/surface_model.h"
#include "dicom/thin.h"

namespace striae::dicom::testing {
namespace {

template <typename Tag>
Id<Tag> MakeId(std::uint8_t seed) {
  std::array<std::uint8_t, 16> bytes{};
  bytes.fill(seed);
  return Id<Tag>(Uuid::FromRandom(bytes));
}

Sha256 MakeHash(std::uint8_t seed) {
  Sha256 hash;
  hash.bytes.fill(seed);
  return hash;
}

Measurement Number(const char* name, const Code& code, double value, const char* unit, double uncertainty,
                   std::vector<Code> equivalents = {}) {
  Measurement m;
  m.name = name;
  m.code = code;
  m.equivalents = std::move(equivalents);
  m.value = value;
  m.unit = unit;
  m.uncertainty = uncertainty;
  return m;
}

void SetSampling(jpeg_compress_struct& jpeg, JpegKind kind) {
  if (kind == JpegKind::kGrey || kind == JpegKind::kRgb) return;
  jpeg.comp_info[0].h_samp_factor = kind == JpegKind::kColour444 ? 1 : 2;
  jpeg.comp_info[0].v_samp_factor = kind == JpegKind::kColour420 ? 2 : 1;
}

}  // namespace

std::vector<std::uint8_t> MakeJpeg(JpegKind kind, int width_px, int height_px, const std::string& secret) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* out = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &out, &size);
  const int channels = kind == JpegKind::kGrey ? 1 : 3;
  jpeg.image_width = static_cast<JDIMENSION>(width_px);
  jpeg.image_height = static_cast<JDIMENSION>(height_px);
  jpeg.input_components = channels;
  jpeg.in_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&jpeg);
  if (kind == JpegKind::kRgb) jpeg_set_colorspace(&jpeg, JCS_RGB);
  SetSampling(jpeg, kind);
  if (kind == JpegKind::kProgressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  const std::string exif = std::string("Exif\0\0", 6) + secret;
  jpeg_write_marker(&jpeg, JPEG_APP0 + 1, reinterpret_cast<const JOCTET*>(exif.data()),
                    static_cast<unsigned>(exif.size()));
  jpeg_write_marker(&jpeg, JPEG_COM, reinterpret_cast<const JOCTET*>(secret.data()),
                    static_cast<unsigned>(secret.size()));
  std::vector<JSAMPLE> line(static_cast<std::size_t>(width_px * channels));
  for (int row = 0; row < height_px; ++row) {
    for (int i = 0; i < width_px * channels; ++i) {
      line[static_cast<std::size_t>(i)] = static_cast<JSAMPLE>(128 + 100 * std::sin(0.1 * i + 0.4 * row));
    }
    JSAMPROW pointer = line.data();
    jpeg_write_scanlines(&jpeg, &pointer, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  std::vector<std::uint8_t> bytes(out, out + size);
  std::free(out);  // NOLINT: libjpeg allocates with malloc
  return bytes;
}

std::vector<std::uint8_t> DecodeJpeg(const std::vector<std::uint8_t>& bytes) {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_decompress(&jpeg);
  jpeg_mem_src(&jpeg, bytes.data(), static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(&jpeg, TRUE);
  jpeg_start_decompress(&jpeg);
  const std::size_t stride = jpeg.output_width * static_cast<std::size_t>(jpeg.output_components);
  std::vector<std::uint8_t> samples(stride * jpeg.output_height);
  while (jpeg.output_scanline < jpeg.output_height) {
    JSAMPROW pointer = samples.data() + stride * jpeg.output_scanline;
    jpeg_read_scanlines(&jpeg, &pointer, 1);
  }
  jpeg_finish_decompress(&jpeg);
  jpeg_destroy_decompress(&jpeg);
  return samples;
}

SessionContext MakeContext() {
  SessionContext context;
  context.study = {MakeId<StudyTag>(1), "STR-26", "Celjenje ran s Črtami", "Test Sponsor", "Test Centre"};
  context.site = {MakeId<SiteTag>(2), "LJ", "Test Clinic", "Europe/Ljubljana"};
  context.subject.id = MakeId<SubjectTag>(3);
  context.subject.pseudonym = "S001";
  context.subject.site = context.site.id;
  context.visit = {MakeId<VisitTag>(4), context.subject.id, "V1"};
  context.session.id = MakeId<SessionTag>(5);
  context.session.subject = context.subject.id;
  context.session.visit = context.visit.id;
  context.session.opened_at = *UtcTime::Parse("2026-05-04T07:08:09.123Z");
  context.device.id = MakeId<DeviceTag>(6);
  context.device.serial = "7001234";
  context.device.model = "NIKON D90";
  return context;
}

Capture MakeWoundCapture() {
  Capture capture;
  capture.id = MakeId<CaptureTag>(7);
  capture.session = MakeContext().session.id;
  capture.sha256 = MakeHash(8);
  capture.file_name = "DSC_0001.JPG";
  capture.media_type = "image/jpeg";
  capture.role = {CaptureRole::Kind::kWound, "W1"};
  capture.body_site = "calf";
  capture.laterality = Laterality::kLeft;
  capture.imported_at = *UtcTime::Parse("2026-05-04T07:10:00Z");
  capture.metadata.make = "NIKON CORPORATION";
  capture.metadata.model = "NIKON D90";
  return capture;
}

Capture MakeHeadCapture() {
  Capture capture = MakeWoundCapture();
  capture.id = MakeId<CaptureTag>(9);
  capture.role = {CaptureRole::Kind::kPose, ""};
  capture.body_site.clear();
  capture.laterality = Laterality::kUnspecified;
  capture.metadata.orientation = 8;
  return capture;
}

Surface MakeSphere(int width_px, int height_px, double radius_mm, int cut_col, double step_mm) {
  Surface surface;
  surface.sensor_width_px = width_px;
  surface.sensor_height_px = height_px;
  const double focal_px = 1000;  // at 1000 mm one pixel is one millimetre
  for (int row = 0; row < height_px; ++row) {
    for (int col = 0; col < width_px; ++col) {
      // The near intersection of the pixel's ray z (x, y, 1) with the sphere around (0, 0, 1000 + radius).
      const double x = (col - 0.5 * (width_px - 1)) / focal_px, y = (row - 0.5 * (height_px - 1)) / focal_px;
      const double a = x * x + y * y + 1, b = 1000 + radius_mm, c = b * b - radius_mm * radius_mm;
      double z = (b - std::sqrt(b * b - a * c)) / a;
      if (cut_col >= 0 && col >= cut_col) z += step_mm;
      surface.point_in_camera.emplace_back(Eigen::Vector3d(z * x, z * y, z).cast<float>());
      surface.colour.push_back({100, 110, 120});
      surface.quality.push_back(0.5F);
      surface.col.push_back(static_cast<std::uint16_t>(col));
      surface.row.push_back(static_cast<std::uint16_t>(row));
    }
  }
  for (int row = 0; row + 1 < height_px; ++row) {
    for (int col = 0; col + 1 < width_px; ++col) {
      if (col + 1 == cut_col) continue;
      const auto tl = static_cast<std::uint32_t>(row * width_px + col), tr = tl + 1;
      const auto bl = tl + static_cast<std::uint32_t>(width_px), br = bl + 1;
      surface.faces.push_back({tl, bl, tr});
      surface.faces.push_back({tr, bl, br});
    }
  }
  return surface;
}

AnalysisReport MakeWoundReport() {
  AnalysisReport report;
  report.analysis = "wound";
  report.version = "1";
  report.provenance.version = "0.1.0";
  report.provenance.inputs = {{"photograph", MakeHash(8)}};
  report.measurements = {Number("volume", {"SCT", "118565006", "Volume"}, 12.345678901234567, "mL", 0.4,
                                {{"LN", "94083-3", "Wound volume"}}),
                         Number("area", {"SCT", "42798000", "Area"}, 9.5, "cm2", 0.1),
                         Number("depth_max", {"SCT", "131197000", "Depth"}, 8, "mm", 0.5),
                         Number("width", {"99STRIAE", "wound-width", "Width of wound"}, 28, "mm", 0.5)};
  report.measurements[2].status = Measurement::Status::kFlagged;
  report.measurements[2].reason = "steep wall seen by no stripe";
  return report;
}

AnalysisReport MakeHeadReport() {
  AnalysisReport report = MakeWoundReport();
  report.analysis = "head";
  report.measurements = {
      Number("rotation", {"99STRIAE", "head-rotation", "Rotation of head against torso"}, -31.5, "deg", 1.2)};
  return report;
}

ThreeObjects MakeObjects(const SessionContext& context) {
  ThreeObjects made;
  made.jpeg = MakeJpeg(JpegKind::kColour422, 61, 47, "Test^Subject");
  const Capture capture = MakeWoundCapture();
  made.photo = EncodePhoto(context, capture, made.jpeg, 1).value();
  const auto thinned = ThinSurface(MakeSphere(40, 30, 300), 500).value();
  made.surface = EncodeSurface(context, capture, thinned, made.photo.reference, "0.1.0").value();
  const MeasurementGroup group{capture,
                               MakeWoundReport(),
                               *UtcTime::Parse("2026-05-04T07:20:00Z"),
                               {made.photo.reference, made.surface.reference}};
  made.measurements = EncodeMeasurements(context, {group}, 1).value();
  return made;
}

}  // namespace striae::dicom::testing
