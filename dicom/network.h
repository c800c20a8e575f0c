// C-ECHO and C-STORE to a PACS.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace striae::dicom {

/// Where to send, and as whom. Each failure says which of these to look at.
struct Peer {
  std::string host;
  int port = 104;
  std::string called_aet = "ANY-SCP";
  std::string calling_aet = "STRIAE";
  int timeout_s = 30;  ///< to connect, to associate, and for every answer
};

/// C-ECHO. kUsage for an impossible address, port or AE title; kNetworkFailed with what to check.
Status Echo(const Peer& peer);

/// What became of one file.
struct SendOutcome {
  std::filesystem::path file;
  std::string sop_class_uid, sop_instance_uid;
  bool stored = false;          ///< the PACS answered success or a warning (data elements coerced)
  bool worth_retrying = false;  ///< not answered, or out of resources (A7xx); other refusals are final
  std::uint16_t status = 0;     ///< DIMSE status of the answer; 0 also when there was none
  std::string message;          ///< why it was not stored, or the warning; empty on success
};

struct SendReport {
  std::vector<SendOutcome> outcomes;  ///< in the order of the files given
  [[nodiscard]] bool AllStored() const;
};

/// C-STORE of DICOM files, each in the transfer syntax it is in, never recoded. An answer for one file does not stop
/// the others. "Stored" means that the PACS took the object; that it keeps it is said only by storage commitment.
/// kUsage without files; kBadFile for one that is no DICOM file (nothing is sent then); kNetworkFailed when no
/// association came about.
Result<SendReport> Send(const std::vector<std::filesystem::path>& files, const Peer& peer);

}  // namespace striae::dicom
