#include "app/kept_surface.h"

#include <algorithm>

#include "app/io/files.h"
#include "app/io/photograph.h"
#include "app/io/preview.h"
#include "app/study.h"
#include "core/ply.h"
#include "reconstruct/reconstruct.h"

namespace striae::app {
namespace {

using store::Derived;
using store::Record;
using store::WorkItem;

/// The surface that the record holds for exactly these sources, or nothing.
Result<std::optional<KeptSurface>> FindSurface(Record& record, const WorkItem& item) {
  const auto derived = record.LatestDerived(item.capture.id, kSurfaceKind);
  if (!derived) return Fail(derived.error());
  if (!*derived || !SameSources((*derived)->provenance, SourcesOf(item))) return std::optional<KeptSurface>();
  const auto bytes = record.ReadDerived(**derived);
  if (!bytes) return Fail(bytes.error());
  auto surface = DecodePly(*bytes);
  if (!surface) return Fail(surface.error(), "the surface kept for " + item.capture.file_name);
  return std::optional(KeptSurface{*std::move(surface), (*derived)->sha256});
}

Status Keep(Record& record, const WorkItem& item, const std::string& kind, const std::string& media_type,
            const Provenance& provenance, const std::vector<std::uint8_t>& bytes) {
  Derived derived;
  derived.capture = item.capture.id;
  derived.kind = kind;
  derived.media_type = media_type;
  derived.provenance = provenance;
  const auto kept = record.AddDerived(derived, bytes, NewStamp());
  return kept ? Status{} : Fail(kept.error());
}

Status KeepPreviews(Record& record, const WorkItem& item, const Provenance& provenance, const Photograph& photograph,
                    const Surface& surface) {
  const auto photo = PhotographPreview(photograph.colour);
  const auto depth = DepthPreview(surface);
  const auto shaded = ShadedPreview(surface);
  const struct {
    const char* kind;
    const Result<std::vector<std::uint8_t>>& png;
  } pictures[] = {{"preview-photo", photo}, {"preview-depth", depth}, {"preview-shaded", shaded}};
  for (const auto& [kind, png] : pictures) {
    if (!png) return Fail(png.error());
    if (Status kept = Keep(record, item, kind, "image/png", provenance, *png); !kept) return kept;
  }
  return {};
}

/// Photograph and calibration from the record -> surface and previews into the record.
Result<KeptSurface> MakeSurface(Record& record, const WorkItem& item) {
  if (!item.calibration) return Fail(ErrorCode::kCalibrationMismatch, item.missing);
  const auto photo_bytes = record.objects().Get(item.capture.sha256);
  if (!photo_bytes) return Fail(photo_bytes.error());
  const auto calibration_bytes = record.objects().Get(item.calibration->sha256);
  if (!calibration_bytes) return Fail(calibration_bytes.error());
  const auto calibration =
      CalibrationFromJson({reinterpret_cast<const char*>(calibration_bytes->data()), calibration_bytes->size()});
  if (!calibration) return Fail(calibration.error());
  const auto photograph = DecodePhotograph(*photo_bytes);
  if (!photograph) return Fail(photograph.error());
  auto reconstruction = reconstruct::Reconstruct(*photograph, *calibration, {});
  if (!reconstruction) return Fail(reconstruction.error());

  const Provenance provenance = NewProvenance(SourcesOf(item));
  const std::vector<std::uint8_t> ply = EncodePly(reconstruction->surface);
  if (Status kept = Keep(record, item, kSurfaceKind, "application/ply", provenance, ply); !kept) {
    return Fail(kept.error());
  }
  if (Status kept = KeepPreviews(record, item, provenance, *photograph, reconstruction->surface); !kept) {
    return Fail(kept.error());
  }
  return KeptSurface{std::move(reconstruction->surface), HashOf(ply)};
}

}  // namespace

/// What a result depends on besides the software: compared before any work is done again.
std::vector<ProvenanceInput> SourcesOf(const WorkItem& item) {
  std::vector<ProvenanceInput> inputs = {{"photograph", item.capture.sha256}};
  if (item.calibration) inputs.push_back({"calibration", item.calibration->sha256});
  return inputs;
}

bool SameSources(const Provenance& provenance, const std::vector<ProvenanceInput>& sources) {
  if (provenance.version != StriaeVersion()) return false;
  const auto holds = [&](const ProvenanceInput& wanted) {
    return std::any_of(provenance.inputs.begin(), provenance.inputs.end(), [&](const ProvenanceInput& input) {
      return input.name == wanted.name && input.sha256 == wanted.sha256;
    });
  };
  return std::all_of(sources.begin(), sources.end(), holds);
}

Provenance NewProvenance(std::vector<ProvenanceInput> inputs) {
  Provenance provenance;
  provenance.version = std::string(StriaeVersion());
  provenance.inputs = std::move(inputs);
  return provenance;
}

Result<KeptSurface> SurfaceOf(Record& record, const WorkItem& item) {
  auto found = FindSurface(record, item);
  if (!found) return Fail(found.error());
  if (*found) return **std::move(found);
  return MakeSurface(record, item);
}

}  // namespace striae::app
