// The one way of a photograph into the record: structure, metadata, preflight, and a Capture ready to be stored.
#pragma once

#include "acquire/source.h"
#include "core/result.h"
#include "core/study.h"

namespace striae::acquire {

/// What only the program knows. Digest, size and time of import are filled in by the record that keeps the bytes.
struct IngestContext {
  CaptureId id;
  RigRange range = RigRange::kSmall;
};

/// The capture with everything that the file itself says. Nothing is written.
/// kBadImage: not a whole photograph; kRecordRefused: it belongs to nobody. Both mean quarantine.
/// A photograph that fails preflight is still a capture: the verdict stands in it.
Result<Capture> Ingest(const IngestItem& item, const IngestContext& context);

}  // namespace striae::acquire
