// Writing attributes into a DCMTK data set: text made safe for its value representation, every condition checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <dcmtk/config/osconfig.h>
// osconfig.h comes first: DCMTK's other headers need it.
#include <dcmtk/dcmdata/dctk.h>

#include "core/measurement.h"
#include "core/result.h"
#include "core/time.h"
#include "dicom/object.h"

namespace striae::dicom::detail {

/// The first failure is kept and all later calls do nothing, so that a module can be written as one list.
class DatasetWriter {
 public:
  explicit DatasetWriter(DcmItem& item) : item_(&item) {}

  /// Text as it stands (UIDs, codes, dates, numbers). Empty text writes an attribute without a value.
  DatasetWriter& Put(const DcmTagKey& tag, std::string_view text);
  /// Free text: CleanText first.
  DatasetWriter& PutText(const DcmTagKey& tag, std::string_view text, std::size_t max_characters = 64);
  DatasetWriter& PutUint16(const DcmTagKey& tag, std::uint16_t value);
  DatasetWriter& PutUint32(const DcmTagKey& tag, std::uint32_t value);
  /// Date and time in UTC; (0008,0201) says so for the whole data set.
  DatasetWriter& PutDateTime(const DcmTagKey& date_tag, const DcmTagKey& time_tag, UtcTime time);
  /// A code sequence with one item; another item when the sequence is there already.
  DatasetWriter& PutCode(const DcmTagKey& sequence, const Code& code);
  /// Class and instance UID (0008,1150), (0008,1155) into this item.
  DatasetWriter& PutSopReference(const ObjectReference& object);
  DatasetWriter& PutEmptySequence(const DcmTagKey& tag);
  /// Appends an item to a sequence (made when absent) and writes into it. Its failure is this writer's, too.
  template <typename Write>
  DatasetWriter& Item(const DcmTagKey& sequence, Write write) {
    DcmItem* nested = nullptr;
    Keep(item_->findOrCreateSequenceItem(sequence, nested, -2), sequence);
    if (!status_ || nested == nullptr) return *this;
    DatasetWriter writer(*nested);
    write(writer);
    if (!writer.status_) status_ = writer.status_;
    return *this;
  }

  [[nodiscard]] DcmItem& item() { return *item_; }
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  void Keep(const OFCondition& condition, const DcmTagKey& tag);

  DcmItem* item_;
  Status status_;
};

/// Backslash (which separates values) becomes '/', control characters become blanks; cut to whole UTF-8 characters.
std::string CleanText(std::string_view text, std::size_t max_characters);

/// "20260504" and "070809.123".
std::string DateText(UtcTime time);
std::string TimeText(UtcTime time);

/// A decimal string (DS): at most 16 characters, as many digits as fit, always with a decimal point.
std::string DecimalText(double value);

/// To be called before DCMTK is used: its data dictionary must be there, or it writes unknown value representations
/// without a word. Also silences its logger: what fails comes back as a condition and is said once, by Striae.
Status PrepareDcmtk();

}  // namespace striae::dicom::detail
