#include "store/detail/audit_hash.h"

#include "store/objects.h"

namespace striae::store::detail {
namespace {

void Append(std::vector<std::uint8_t>& bytes, const std::optional<std::string>& text) {
  if (!text) {
    bytes.push_back('-');
    return;
  }
  const std::string length = std::to_string(text->size()) + ":";
  bytes.insert(bytes.end(), length.begin(), length.end());
  bytes.insert(bytes.end(), text->begin(), text->end());
}

}  // namespace

Sha256 HashOf(const AuditRow& row) {
  std::vector<std::uint8_t> bytes(row.previous_hash.bytes.begin(), row.previous_hash.bytes.end());
  const Stamp& stamp = row.stamp;
  for (const std::string& text :
       {row.origin, std::to_string(row.sequence), stamp.now.ToString(), std::to_string(stamp.utc_offset_min),
        stamp.zone, stamp.user, stamp.machine, row.software, row.action, row.entity, row.entity_id, row.field}) {
    Append(bytes, text);
  }
  Append(bytes, row.old_value);
  Append(bytes, row.new_value);
  Append(bytes, row.reason);
  return store::HashOf(bytes);
}

AuditRow ReadAuditRow(const RowView& row) {
  AuditRow audit;
  audit.origin = row.Text(0);
  audit.sequence = row.Integer(1);
  audit.stamp.now = row.Time(2);
  audit.stamp.utc_offset_min = static_cast<int>(row.Integer(3));
  audit.stamp.zone = row.Text(4);
  audit.stamp.user = row.Text(5);
  audit.stamp.machine = row.Text(6);
  audit.software = row.Text(7);
  audit.action = row.Text(8);
  audit.entity = row.Text(9);
  audit.entity_id = row.Text(10);
  audit.field = row.Text(11);
  audit.old_value = row.OptionalText(12);
  audit.new_value = row.OptionalText(13);
  audit.reason = row.Text(14);
  audit.previous_hash = row.Hash(15);
  audit.hash = row.Hash(16);
  return audit;
}

}  // namespace striae::store::detail
