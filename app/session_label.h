// The printed label in a study's photograph: does it belong to the session that the photograph was logged in?
#pragma once

#include <optional>
#include <string>

#include "core/hex.h"
#include "core/result.h"
#include "store/record.h"

namespace striae::app {

inline constexpr const char* kLabelKind = "label";

/// A label that is not the one of the photograph's session.
struct ForeignLabel {
  int marker_id = 0;
  Sha256 evidence;     ///< of the file (kind "label") that says which marker the photograph shows
  std::string reason;  ///< whose label it is, and what to do
};

/// Nothing where no label shows, or where it is this session's own. Labels have one of a thousand numbers
/// (core/target.h), so that another session's label passes for this one's once in a thousand times. Each photograph is
/// looked through once; what was seen is kept with its capture, unless the session is locked. kIo and kRecordDamaged as
/// the record; a photograph that cannot be decoded shows no label.
Result<std::optional<ForeignLabel>> ForeignLabelIn(store::Record& record, const store::WorkItem& item);

/// Notes it as a deviation about the capture; once, however often it is found.
Status NoteDeviation(store::Record& record, const store::WorkItem& item, const ForeignLabel& label);

}  // namespace striae::app
