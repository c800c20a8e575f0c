// Files made from a capture, each with what it was made from and how.
#include "store/detail/codec.h"
#include "store/detail/compress.h"
#include "store/detail/keep.h"
#include "store/detail/read.h"
#include "store/detail/words.h"

namespace striae::store {

Result<Derived> Record::AddDerived(const Derived& derived, std::span<const std::uint8_t> bytes, const Stamp& stamp) {
  return Guarded([&] {
    if (derived.kind.empty() || bytes.empty()) {
      Refuse(ErrorCode::kUsage, "a derived file needs a kind and content; nothing was kept");
    }
    Database& database = impl_->database;
    const std::string capture = detail::GetCapture(database, derived.capture).id.ToString();
    Derived kept = derived;
    kept.sha256 = HashOf(bytes);
    kept.size_bytes = bytes.size();
    kept.made_at = stamp.now;
    const auto there = database.One(std::string(detail::kDerived) +
                                        " WHERE capture_id = ? AND kind = ? AND sha256 = ? "
                                        "AND number = (SELECT max(number) FROM derived d WHERE d.capture_id = "
                                        "derived.capture_id AND d.kind = derived.kind)",
                                    detail::ReadDerivedRow, derived.capture, derived.kind, kept.sha256);
    if (there && impl_->objects.Verify(there->object)) return *there;
    const auto frame = derived.kind == "surface" ? detail::Compress(bytes) : std::vector<std::uint8_t>();
    const std::span<const std::uint8_t> content = frame.empty() ? bytes : std::span<const std::uint8_t>(frame);
    kept.object = detail::Unwrap(frame.empty() ? impl_->objects.Put(bytes, kept.sha256) : impl_->objects.Put(frame));
    if (there && there->object == kept.object) return *there;  // it was lost from objects/ and is back now
    Change change(database, stamp);
    detail::InsertObject(change, database, kept.object, content.size(), stamp);
    const auto number = detail::NextNumber(database, "derived", "capture_id", capture);
    const Uuid id = detail::UuidFrom({"derived", capture, std::to_string(number), kept.kind, kept.sha256.ToString()});
    change.Insert("derived", {{"id", ToValue(id.ToString())},
                              {"capture_id", ToValue(capture)},
                              {"number", number},
                              {"kind", ToValue(kept.kind)},
                              {"media_type", ToValue(kept.media_type)},
                              {"sha256", ToValue(kept.sha256)},
                              {"object", ToValue(kept.object)},
                              {"size_bytes", ToValue(kept.size_bytes)},
                              {"provenance", ToValue(detail::Dump(detail::ProvenanceToJson(kept.provenance)))},
                              {"made_at", ToValue(kept.made_at)}});
    change.Commit();
    return kept;
  });
}

Result<std::vector<Derived>> Record::DerivedOf(const CaptureId& capture) {
  return Guarded([&] {
    detail::GetCapture(impl_->database, capture);
    return impl_->database.Rows(std::string(detail::kDerived) + " WHERE capture_id = ? ORDER BY number",
                                detail::ReadDerivedRow, capture);
  });
}

Result<std::optional<Derived>> Record::LatestDerived(const CaptureId& capture, std::string_view kind) {
  return Guarded([&] {
    detail::GetCapture(impl_->database, capture);
    return impl_->database.One(
        std::string(detail::kDerived) + " WHERE capture_id = ? AND kind = ? ORDER BY number DESC LIMIT 1",
        detail::ReadDerivedRow, capture, kind);
  });
}

Result<std::vector<std::uint8_t>> Record::ReadDerived(const Derived& derived) {
  return Guarded([&] {
    auto content = detail::Unwrap(impl_->objects.Get(derived.object));
    if (derived.object == derived.sha256) return content;
    auto bytes = detail::Decompress(content, derived.size_bytes);
    if (HashOf(bytes) != derived.sha256) {
      Refuse(ErrorCode::kRecordDamaged, "the " + derived.kind + " of capture " + derived.capture.ToString() +
                                            " is not what was kept; run 'striae check'");
    }
    return bytes;
  });
}

}  // namespace striae::store
