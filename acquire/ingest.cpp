#include "acquire/ingest.h"

#include <string>

#include "acquire/metadata.h"
#include "acquire/preflight.h"
#include "acquire/structure.h"

namespace striae::acquire {
namespace {

PreflightItem TrailingBytes(std::size_t count) {
  PreflightItem item;
  item.name = "file end";
  item.state = PreflightItem::State::kWarning;
  item.found = std::to_string(count) + " bytes after the picture";
  item.expected = "nothing after the picture";
  item.advice = "compare with the file on the card: a copying program may have changed it";
  return item;
}

}  // namespace

Result<Capture> Ingest(const IngestItem& item, const IngestContext& context) {
  if (!item.binding) {
    return Fail(ErrorCode::kRecordRefused,
                item.origin + ": taken without a session, so it belongs to nobody; look at it and import it by hand");
  }
  const auto structure = CheckStructure(item.bytes);
  if (!structure) return Fail(structure.error(), item.origin);
  auto metadata = ReadMetadata(item.bytes);
  if (!metadata) return Fail(metadata.error(), item.origin);

  Capture capture;
  capture.id = context.id;
  capture.session = item.binding->session;
  capture.file_name = item.file_name;
  capture.media_type = structure->media_type;
  capture.size_bytes = item.bytes.size();
  capture.role = item.binding->role;
  capture.body_site = item.binding->body_site;
  capture.laterality = item.binding->laterality;
  capture.metadata = std::move(*metadata);
  capture.preflight = Preflight(capture.metadata, context.range);
  if (structure->media_type == "image/jpeg" && structure->trailing_bytes > 0) {
    capture.preflight.push_back(TrailingBytes(structure->trailing_bytes));
  }
  return capture;
}

}  // namespace striae::acquire
