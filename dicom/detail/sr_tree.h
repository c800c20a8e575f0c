// A content tree under construction. DCMTK refuses items and relationships that Comprehensive 3D SR does not allow.
#pragma once

#include <string>

#include <dcmtk/config/osconfig.h>
// osconfig.h comes first: DCMTK's other headers need it.
#include <dcmtk/dcmsr/dsrdoctr.h>

#include "core/measurement.h"
#include "core/result.h"
#include "dicom/object.h"

namespace striae::dicom::detail {

/// Adds children below the current item, which is the root to begin with. The first failure is kept.
class SrTree {
 public:
  /// Starts with the root container of this title and template.
  SrTree(DSRDocumentTree& tree, const Code& title, const std::string& template_id);

  using Relation = DSRTypes::E_RelationshipType;
  /// Goes down into the new container; Up() leaves it.
  SrTree& Container(const Code& name, const std::string& template_id = "");
  SrTree& AddCode(Relation relation, const Code& name, const Code& value);
  SrTree& Text(Relation relation, const Code& name, const std::string& value);
  SrTree& Uid(Relation relation, const Code& name, const std::string& value);
  /// A number with a UCUM unit (check.h knows which).
  SrTree& Number(Relation relation, const Code& name, double value, const std::string& unit);
  /// IMAGE for a photograph, COMPOSITE for anything else.
  SrTree& Reference(Relation relation, const Code& name, const ObjectReference& object);
  /// The item added last becomes the current one: what follows is added below it until Up().
  SrTree& Down();
  SrTree& Up();

  [[nodiscard]] const Status& status() const { return status_; }

 private:
  bool Add(Relation relation, DSRTypes::E_ValueType type, const Code& name);
  void Keep(const OFCondition& condition, const Code& name);
  void Leave();

  DSRDocumentTree* tree_;
  Status status_;
};

}  // namespace striae::dicom::detail
