#include "dicom/detail/encode.h"

#include <utility>

#include <dcmtk/dcmdata/dcostrmb.h>

#include "dicom/uid.h"

namespace striae::dicom::detail {
namespace {

Status Failed(const OFCondition& condition) {
  return Fail(ErrorCode::kInternal, std::string("cannot encode the DICOM object: ") + condition.text());
}

/// Encodes through a fixed buffer that is emptied as often as it is full.
template <typename WriteTo>
Result<std::vector<std::uint8_t>> Encode(WriteTo write) {
  std::vector<std::uint8_t> buffer(1U << 20U);
  std::vector<std::uint8_t> bytes;
  DcmOutputBufferStream stream(buffer.data(), static_cast<offile_off_t>(buffer.size()));
  OFCondition condition = EC_StreamNotifyClient;
  while (condition == EC_StreamNotifyClient) {
    condition = write(stream);
    if (condition.bad() && condition != EC_StreamNotifyClient) return Fail(Failed(condition).error());
    void* filled = nullptr;
    offile_off_t length = 0;
    stream.flushBuffer(filled, length);
    const auto* begin = static_cast<const std::uint8_t*>(filled);
    bytes.insert(bytes.end(), begin, begin + length);
  }
  return bytes;
}

std::string Text(DcmItem& item, const DcmTagKey& tag) {
  OFString text;
  item.findAndGetOFString(tag, text).good();
  return text.c_str();
}

}  // namespace

Result<Object> Finish(ObjectKind kind, DcmFileFormat& file, E_TransferSyntax transfer_syntax) {
  DcmDataset& dataset = *file.getDataset();
  delete dataset.remove(DCM_SOPInstanceUID);
  if (const auto chosen = dataset.chooseRepresentation(transfer_syntax, nullptr); chosen.bad()) {
    return Fail(Failed(chosen).error());
  }
  dataset.transferInit();
  const auto content = Encode([&](DcmOutputStream& stream) {
    return dataset.write(stream, transfer_syntax, EET_ExplicitLength, nullptr, EGL_recalcGL);
  });
  dataset.transferEnd();
  if (!content) return Fail(content.error());

  Object object;
  object.reference = {kind, Text(dataset, DCM_StudyInstanceUID), Text(dataset, DCM_SeriesInstanceUID),
                      Text(dataset, DCM_SOPClassUID), UidOfContent(*content)};
  DatasetWriter writer(dataset);
  writer.Put(DCM_SOPInstanceUID, object.reference.sop_instance_uid);
  if (!writer.status()) return Fail(writer.status().error());
  if (const auto valid = file.validateMetaInfo(transfer_syntax); valid.bad()) return Fail(Failed(valid).error());
  file.transferInit();
  auto bytes = Encode([&](DcmOutputStream& stream) {
    return file.write(stream, transfer_syntax, EET_ExplicitLength, nullptr, EGL_recalcGL, EPD_withoutPadding);
  });
  file.transferEnd();
  if (!bytes) return Fail(bytes.error());
  object.bytes = std::move(*bytes);
  return object;
}

}  // namespace striae::dicom::detail
