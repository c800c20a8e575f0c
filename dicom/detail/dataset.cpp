#include "dicom/detail/dataset.h"

#include <array>
#include <charconv>

#include <dcmtk/oflog/oflog.h>

namespace striae::dicom::detail {

void DatasetWriter::Keep(const OFCondition& condition, const DcmTagKey& tag) {
  if (condition.bad() && status_) {
    status_ = Fail(ErrorCode::kInternal,
                   std::string("cannot write DICOM attribute ") + tag.toString().c_str() + ": " + condition.text());
  }
}

DatasetWriter& DatasetWriter::Put(const DcmTagKey& tag, std::string_view text) {
  if (!status_) return *this;
  if (text.empty()) {
    Keep(item_->insertEmptyElement(tag), tag);
  } else {
    Keep(item_->putAndInsertOFStringArray(tag, OFString(text.data(), text.size())), tag);
  }
  return *this;
}

DatasetWriter& DatasetWriter::PutText(const DcmTagKey& tag, std::string_view text, std::size_t max_characters) {
  return Put(tag, CleanText(text, max_characters));
}

DatasetWriter& DatasetWriter::PutUint16(const DcmTagKey& tag, std::uint16_t value) {
  if (status_) Keep(item_->putAndInsertUint16(tag, value), tag);
  return *this;
}

DatasetWriter& DatasetWriter::PutUint32(const DcmTagKey& tag, std::uint32_t value) {
  if (status_) Keep(item_->putAndInsertUint32(tag, value), tag);
  return *this;
}

DatasetWriter& DatasetWriter::PutDateTime(const DcmTagKey& date_tag, const DcmTagKey& time_tag, UtcTime time) {
  return Put(date_tag, DateText(time)).Put(time_tag, TimeText(time));
}

DatasetWriter& DatasetWriter::PutCode(const DcmTagKey& sequence, const Code& code) {
  return Item(sequence, [&code](DatasetWriter& item) {
    item.Put(DCM_CodeValue, code.value)
        .Put(DCM_CodingSchemeDesignator, code.scheme)
        .PutText(DCM_CodeMeaning, code.meaning);
  });
}

DatasetWriter& DatasetWriter::PutSopReference(const ObjectReference& object) {
  return Put(DCM_ReferencedSOPClassUID, object.sop_class_uid)
      .Put(DCM_ReferencedSOPInstanceUID, object.sop_instance_uid);
}

DatasetWriter& DatasetWriter::PutEmptySequence(const DcmTagKey& tag) {
  if (status_) Keep(item_->insertEmptyElement(tag), tag);
  return *this;
}

std::string CleanText(std::string_view text, std::size_t max_characters) {
  std::string out;
  std::size_t characters = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool begins_character = (byte & 0xC0U) != 0x80U;
    if (begins_character && ++characters > max_characters) break;
    if (c == '\\') {
      out.push_back('/');
    } else {
      out.push_back(byte < 0x20 || byte == 0x7F ? ' ' : c);
    }
  }
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

std::string DateText(UtcTime time) {
  const std::string iso = time.ToString();
  return iso.substr(0, 4) + iso.substr(5, 2) + iso.substr(8, 2);
}

std::string TimeText(UtcTime time) {
  const std::string iso = time.ToString();
  return iso.substr(11, 2) + iso.substr(14, 2) + iso.substr(17, 6);
}

std::string DecimalText(double value) {
  constexpr std::size_t kLongest = 16;
  std::array<char, 64> buffer{};
  auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  for (int digits = 15; end - buffer.data() > static_cast<std::ptrdiff_t>(kLongest) && digits > 0; --digits) {
    end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, digits).ptr;
  }
  return {buffer.data(), end};
}

Status PrepareDcmtk() {
  static const bool quiet = [] {
    OFLog::configure(OFLogger::OFF_LOG_LEVEL);
    return true;
  }();
  static_cast<void>(quiet);
  if (dcmDataDict.isDictionaryLoaded()) return {};
  return Fail(
      ErrorCode::kInternal,
      "DCMTK's data dictionary is not loaded; install the package dcmtk's library completely or set DCMDICTPATH "
      "to dicom.dic");
}

}  // namespace striae::dicom::detail
