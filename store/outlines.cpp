// Wound outlines as they were drawn: append-only, the newest counts.
#include "store/detail/keep.h"
#include "store/detail/read.h"
#include "store/detail/words.h"

namespace striae::store {
namespace {

void RefuseUnlessOn(const Capture& capture, const Outline& outline) {
  if (outline.polygon_px.size() < 3) {
    Refuse(ErrorCode::kBadFile, "an outline needs at least three points; draw it again");
  }
  if (outline.image_sha256 && *outline.image_sha256 != capture.sha256) {
    Refuse(ErrorCode::kRecordRefused, "this outline was drawn on another photograph (SHA-256 " +
                                          outline.image_sha256->ToString().substr(0, 12) + "..., not " +
                                          capture.sha256.ToString().substr(0, 12) + "... of " + capture.file_name +
                                          "); name the capture that it belongs to");
  }
  const int width = capture.metadata.width_px, height = capture.metadata.height_px;
  if (width <= 0 || height <= 0) return;  // size not known
  for (const Eigen::Vector2d& point : outline.polygon_px) {
    // Pixel centres are whole numbers: the photograph reaches from -0.5 to width - 0.5.
    if (point.x() < -0.5 || point.y() < -0.5 || point.x() > width - 0.5 || point.y() > height - 0.5) {
      Refuse(ErrorCode::kBadFile, "the outline leaves the photograph (" + std::to_string(width) + " x " +
                                      std::to_string(height) + " pixels); was it drawn on a scaled or turned copy?");
    }
  }
}

}  // namespace

Result<StoredOutline> Record::AddOutline(const OutlineId& id, const CaptureId& capture, const Outline& outline,
                                         const Stamp& stamp) {
  return Guarded([&] {
    Database& database = impl_->database;
    const Capture on = detail::GetCapture(database, capture);
    RefuseUnlessOn(on, outline);
    Outline kept = outline;
    kept.image_sha256 = on.sha256;
    const std::string text = ToJsonText(kept);
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    const Sha256 sha256 = detail::Unwrap(impl_->objects.Put(bytes));
    Change change(database, stamp);
    const auto latest = detail::FindOutline(database, impl_->objects, capture);
    if (latest && latest->sha256 == sha256) return *latest;
    detail::InsertObject(change, database, sha256, bytes.size(), stamp);
    change.Insert("outline", {{"id", ToValue(id)},
                              {"capture_id", ToValue(capture)},
                              {"number", detail::NextNumber(database, "outline", "capture_id", capture.ToString())},
                              {"sha256", ToValue(sha256)},
                              {"drawn_by", ToValue(stamp.user)},
                              {"added_at", ToValue(stamp.now)}});
    change.Commit();
    return StoredOutline{id, capture, sha256, stamp.user, stamp.now, kept};
  });
}

Result<std::optional<StoredOutline>> Record::LatestOutline(const CaptureId& capture) {
  return Guarded([&] {
    detail::GetCapture(impl_->database, capture);
    return detail::FindOutline(impl_->database, impl_->objects, capture);
  });
}

}  // namespace striae::store
