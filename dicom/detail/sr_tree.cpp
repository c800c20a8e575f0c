#include "dicom/detail/sr_tree.h"

#include <dcmtk/dcmsr/dsrcodvl.h>
#include <dcmtk/dcmsr/dsrcomvl.h>
#include <dcmtk/dcmsr/dsrimgvl.h>
#include <dcmtk/dcmsr/dsrnumvl.h>

#include "dicom/check.h"
#include "dicom/detail/dataset.h"

namespace striae::dicom::detail {
namespace {

DSRCodedEntryValue Coded(const Code& code) {
  return {code.value.c_str(), code.scheme.c_str(), CleanText(code.meaning, 64).c_str()};
}

}  // namespace

SrTree::SrTree(DSRDocumentTree& tree, const Code& title, const std::string& template_id) : tree_(&tree) {
  if (tree_->addContentItem(DSRTypes::RT_isRoot, DSRTypes::VT_Container, DSRTypes::AM_afterCurrent) == 0) {
    status_ = Fail(ErrorCode::kInternal, "cannot start the DICOM report");
    return;
  }
  Keep(tree_->getCurrentContentItem().setConceptName(Coded(title)), title);
  Keep(tree_->getCurrentContentItem().setTemplateIdentification(template_id.c_str(), "DCMR"), title);
}

void SrTree::Keep(const OFCondition& condition, const Code& name) {
  if (condition.bad() && status_) {
    status_ =
        Fail(ErrorCode::kInternal, "cannot write \"" + name.meaning + "\" into the DICOM report: " + condition.text());
  }
}

bool SrTree::Add(Relation relation, DSRTypes::E_ValueType type, const Code& name) {
  if (!status_) return false;
  if (tree_->addContentItem(relation, type, DSRTypes::AM_belowCurrent) == 0) {
    status_ = Fail(ErrorCode::kInternal, "\"" + name.meaning + "\" is not allowed at its place in the DICOM report");
    return false;
  }
  Keep(tree_->getCurrentContentItem().setConceptName(Coded(name)), name);
  return true;
}

/// Back to the parent, so that the next item becomes a sibling.
void SrTree::Leave() {
  if (status_) tree_->goUp();
}

SrTree& SrTree::Container(const Code& name, const std::string& template_id) {
  if (Add(DSRTypes::RT_contains, DSRTypes::VT_Container, name) && !template_id.empty()) {
    Keep(tree_->getCurrentContentItem().setTemplateIdentification(template_id.c_str(), "DCMR"), name);
  }
  return *this;
}

SrTree& SrTree::AddCode(Relation relation, const Code& name, const Code& value) {
  if (Add(relation, DSRTypes::VT_Code, name)) {
    Keep(tree_->getCurrentContentItem().setCodeValue(Coded(value)), name);
    Leave();
  }
  return *this;
}

SrTree& SrTree::Text(Relation relation, const Code& name, const std::string& value) {
  if (Add(relation, DSRTypes::VT_Text, name)) {
    // 1024 characters are far above any reason; a backslash is an ordinary character in a text value (UT).
    Keep(tree_->getCurrentContentItem().setStringValue(CleanText(value, 1024).c_str()), name);
    Leave();
  }
  return *this;
}

SrTree& SrTree::Uid(Relation relation, const Code& name, const std::string& value) {
  if (Add(relation, DSRTypes::VT_UIDRef, name)) {
    Keep(tree_->getCurrentContentItem().setStringValue(value.c_str()), name);
    Leave();
  }
  return *this;
}

SrTree& SrTree::Number(Relation relation, const Code& name, double value, const std::string& unit) {
  const auto meaning = MeaningOfUnit(unit);
  if (!meaning && status_) status_ = Fail(meaning.error());
  if (Add(relation, DSRTypes::VT_Num, name)) {
    const Code ucum{"UCUM", unit, std::string(*meaning)};
    DSRNumericMeasurementValue number(DecimalText(value).c_str(), Coded(ucum));
    // A decimal string has room for fewer digits than a double; the full value stands beside it.
    Keep(number.setFloatingPointRepresentation(value), name);
    Keep(tree_->getCurrentContentItem().setNumericValue(number), name);
    Leave();
  }
  return *this;
}

SrTree& SrTree::Reference(Relation relation, const Code& name, const ObjectReference& object) {
  const char* sop_class = object.sop_class_uid.c_str();
  const char* instance = object.sop_instance_uid.c_str();
  if (object.kind == ObjectKind::kPhoto) {
    if (Add(relation, DSRTypes::VT_Image, name)) {
      Keep(tree_->getCurrentContentItem().setImageReference(DSRImageReferenceValue(sop_class, instance)), name);
      Leave();
    }
  } else if (Add(relation, DSRTypes::VT_Composite, name)) {
    Keep(tree_->getCurrentContentItem().setCompositeReference(DSRCompositeReferenceValue(sop_class, instance)), name);
    Leave();
  }
  return *this;
}

SrTree& SrTree::Down() {
  if (!status_) return *this;
  if (tree_->goDown() == 0) {
    status_ = Fail(ErrorCode::kInternal, "there is no item to go down into in the DICOM report");
    return *this;
  }
  while (tree_->gotoNext() != 0) {
  }
  return *this;
}

SrTree& SrTree::Up() {
  Leave();
  return *this;
}

}  // namespace striae::dicom::detail
