// The surface of a capture: the one that the record holds for the same sources, else computed and kept.
#pragma once

#include <vector>

#include "core/provenance.h"
#include "core/surface.h"
#include "store/record.h"

namespace striae::app {

constexpr const char* kSurfaceKind = "surface";

/// A surface with its place in the record.
struct KeptSurface {
  Surface surface;
  Sha256 sha256;
};

/// What a result depends on besides the software: compared before any work is done again.
std::vector<ProvenanceInput> SourcesOf(const store::WorkItem& item);
/// Made by this version from all of these.
bool SameSources(const Provenance& provenance, const std::vector<ProvenanceInput>& sources);
/// Of this version.
Provenance NewProvenance(std::vector<ProvenanceInput> inputs);

/// Surface and previews are in the record when this returns. Errors: those of the reconstruction and the record.
Result<KeptSurface> SurfaceOf(store::Record& record, const store::WorkItem& item);

}  // namespace striae::app
