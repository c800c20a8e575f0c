// A session of the record as DICOM objects: photographs, surfaces, one report of all measurements.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/result.h"
#include "core/study.h"
#include "dicom/object.h"
#include "store/record.h"

namespace striae::app {

struct ExportedObject {
  std::string file_name;
  dicom::ObjectReference reference;
  std::optional<CaptureId> capture;  ///< none for the report, which is about all of them
};

/// A capture, or a part of it, for which there is no object, and why.
struct LeftOut {
  CaptureId capture;
  std::string file_name, reason;
};

struct SessionExport {
  std::vector<ExportedObject> objects;
  std::vector<LeftOut> left_out;
};

/// Writes one file an object into `folder` (made when absent): photo-<capture>.dcm, surface-<capture>.dcm,
/// measurements-<session>.dcm. All files are whole before the first takes its place; on an error none does. The same
/// record gives the same files with the same UIDs. `strip_jpeg_metadata` as in dicom::SessionContext.
/// kRecordRefused after the subject withdrew consent; kNotFound when the session has nothing to export.
Result<SessionExport> ExportSession(store::Record& record, const SessionId& session, bool strip_jpeg_metadata,
                                    const std::filesystem::path& folder);

/// {"session", "folder", "objects": [{"kind", "file", "capture", ...UIDs}], "left_out": [{"capture", "file",
/// "reason"}]}
nlohmann::json ToJson(const SessionExport& exported, const SessionId& session, const std::filesystem::path& folder);

}  // namespace striae::app
