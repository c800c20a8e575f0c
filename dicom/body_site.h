// Anatomic sites as SNOMED CT codes (DICOM PS3.16 CID 4031 and its like), from what an operator typed.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/measurement.h"
#include "core/study.h"

namespace striae::dicom {

struct BodySite {
  Code code;
  std::string body_part_examined;  ///< (0018,0015) defined term
  bool paired = false;             ///< has a left and a right
  bool recognizable = false;       ///< may show a face
};

/// Case and surplus blanks do not matter: "calf", "Lower leg", "foot". nullopt for a word that is not in the table.
std::optional<BodySite> FindBodySite(std::string_view typed);

/// The site of a capture: its body_site; for a head pose without one, the head.
std::optional<BodySite> SiteOf(const Capture& capture);

/// Right 24028007, left 7771000, bilateral 51440002 (SCT); nullopt for unspecified and unpaired.
std::optional<Code> LateralityCode(Laterality laterality);

/// True if a viewer could recognise a person: head poses, face, head, neck, and whatever is not known.
bool MayBeRecognizable(const Capture& capture);

}  // namespace striae::dicom
