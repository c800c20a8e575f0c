#include "dicom/network.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <optional>

#include "dicom/detail/dataset.h"
// DCMTK's network headers need osconfig.h, which dataset.h brings.
#include <dcmtk/dcmnet/dstorscu.h>

namespace striae::dicom {
namespace {

/// A storage user that remembers each answer.
class RememberingScu : public DcmStorageSCU {
 public:
  struct Answer {
    bool accepted = false;  ///< the PACS takes this kind of object in this transfer syntax
    bool answered = false;
    std::uint16_t status = 0;
  };
  /// By SOP Instance UID.
  [[nodiscard]] const std::map<std::string, Answer>& answers() const { return answers_; }

 protected:
  void notifySOPInstanceSent(const TransferEntry& entry) override {
    // What is not compressed may go in another uncompressed transfer syntax.
    const auto context = entry.Uncompressed ? findAnyPresentationContextID(entry.SOPClassUID, entry.TransferSyntaxUID)
                                            : findPresentationContextID(entry.SOPClassUID, entry.TransferSyntaxUID);
    answers_[entry.SOPInstanceUID.c_str()] = {context != 0, static_cast<bool>(entry.RequestSent),
                                              entry.ResponseStatusCode};
  }

 private:
  std::map<std::string, Answer> answers_;
};

bool IsAet(const std::string& aet) {
  return !aet.empty() && aet.size() <= 16 && aet.find_first_not_of(' ') != std::string::npos &&
         std::all_of(aet.begin(), aet.end(), [](char c) { return c >= ' ' && c <= '~' && c != '\\'; });
}

Status CheckPeer(const Peer& peer) {
  if (peer.host.empty()) return Fail(ErrorCode::kUsage, "no host given for the PACS");
  if (peer.port < 1 || peer.port > 65535) {
    return Fail(ErrorCode::kUsage, "port " + std::to_string(peer.port) + " is not between 1 and 65535");
  }
  for (const std::string& aet : {peer.called_aet, peer.calling_aet}) {
    if (!IsAet(aet)) return Fail(ErrorCode::kUsage, "AE title \"" + aet + "\" must have 1 to 16 ASCII characters");
  }
  if (peer.timeout_s < 1) return Fail(ErrorCode::kUsage, "the timeout must be at least one second");
  return detail::PrepareDcmtk();
}

void Address(DcmSCU& scu, const Peer& peer) {
  scu.setPeerHostName(peer.host.c_str());
  scu.setPeerPort(static_cast<Uint16>(peer.port));
  scu.setPeerAETitle(peer.called_aet.c_str());
  scu.setAETitle(peer.calling_aet.c_str());
  scu.setConnectionTimeout(peer.timeout_s);
  scu.setACSETimeout(static_cast<Uint32>(peer.timeout_s));
  scu.setDIMSETimeout(static_cast<Uint32>(peer.timeout_s));
  scu.setDIMSEBlockingMode(DIMSE_NONBLOCKING);
  scu.setVerbosePCMode(OFFalse);
}

std::string Where(const Peer& peer) { return peer.called_aet + " at " + peer.host + ":" + std::to_string(peer.port); }

Error Unreachable(const Peer& peer, const OFCondition& condition) {
  std::string reason = condition.text();
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  std::string advice = "check that the PACS runs, host and port, and the firewall";
  if (condition == DUL_ASSOCIATIONREJECTED) {
    advice = "it does not accept the AE titles: called " + peer.called_aet + ", calling " + peer.calling_aet +
             "; ask the PACS administrator to admit them";
  } else if (condition == NET_EC_NoAcceptablePresentationContexts) {
    advice =
        "it accepts none of the object types offered; ask the PACS administrator to admit VL Photographic (JPEG "
        "Baseline), Encapsulated STL and Comprehensive 3D SR";
  }
  return {ErrorCode::kNetworkFailed, Where(peer) + " does not take the connection (" + reason + "): " + advice, {}};
}

std::string HexText(std::uint16_t status) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "0x%04X", static_cast<unsigned>(status));
  return text.data();
}

/// Reads class and instance of every file before anything is sent.
Result<std::vector<SendOutcome>> Identify(const std::vector<std::filesystem::path>& files) {
  std::vector<SendOutcome> outcomes;
  for (const std::filesystem::path& path : files) {
    DcmFileFormat file;
    // The meta information alone says what the file is; the data set is read when it is sent.
    const auto loaded = file.loadFile(path.c_str(), EXS_Unknown, EGL_noChange, DCM_MaxReadLength, ERM_metaOnly);
    OFString sop_class, instance;
    if (loaded.bad() || file.getMetaInfo() == nullptr ||
        file.getMetaInfo()->findAndGetOFString(DCM_MediaStorageSOPClassUID, sop_class).bad() ||
        file.getMetaInfo()->findAndGetOFString(DCM_MediaStorageSOPInstanceUID, instance).bad() || instance.empty()) {
      return Fail(ErrorCode::kBadFile, path.string() + " is not a DICOM file; nothing was sent");
    }
    SendOutcome outcome;
    outcome.file = path;
    outcome.sop_class_uid = sop_class.c_str();
    outcome.sop_instance_uid = instance.c_str();
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

void Judge(SendOutcome& outcome, const std::map<std::string, RememberingScu::Answer>& answers,
           const std::string& broken) {
  const auto found = answers.find(outcome.sop_instance_uid);
  if (found == answers.end() || !found->second.answered) {
    outcome.worth_retrying = found == answers.end() || found->second.accepted;
    outcome.message = !outcome.worth_retrying ? "the PACS does not accept this kind of object or its transfer syntax"
                      : broken.empty()        ? "the connection broke before it was answered"
                                              : "the connection broke before it was answered: " + broken;
    return;
  }
  outcome.status = found->second.status;
  const unsigned family = outcome.status & 0xFF00U;
  outcome.stored = outcome.status == 0 || (outcome.status & 0xF000U) == 0xB000U;
  outcome.worth_retrying = family == 0xA700U;
  if (outcome.stored && outcome.status != 0) outcome.message = "stored with warning " + HexText(outcome.status);
  if (!outcome.stored) {
    outcome.message = "refused with status " + HexText(outcome.status) +
                      (outcome.worth_retrying ? " (out of resources): try again later" : ": see the PACS's log");
  }
}

}  // namespace

bool SendReport::AllStored() const {
  return std::all_of(outcomes.begin(), outcomes.end(), [](const SendOutcome& outcome) { return outcome.stored; });
}

Status Echo(const Peer& peer) {
  if (auto usable = CheckPeer(peer); !usable) return usable;
  DcmSCU scu;
  Address(scu, peer);
  OFList<OFString> syntaxes;
  syntaxes.push_back(UID_LittleEndianImplicitTransferSyntax);
  scu.addPresentationContext(UID_VerificationSOPClass, syntaxes);
  OFCondition condition = scu.initNetwork();
  if (condition.good()) condition = scu.negotiateAssociation();
  if (condition.bad()) return Fail(Unreachable(peer, condition));
  condition = scu.sendECHORequest(0);
  scu.releaseAssociation();
  if (condition.bad()) {
    return Fail(ErrorCode::kNetworkFailed,
                Where(peer) + " took the connection but not the C-ECHO: " + condition.text());
  }
  return {};
}

Result<SendReport> Send(const std::vector<std::filesystem::path>& files, const Peer& peer) {
  if (auto usable = CheckPeer(peer); !usable) return Fail(usable.error());
  if (files.empty()) return Fail(ErrorCode::kUsage, "there are no DICOM files to send");
  auto outcomes = Identify(files);
  if (!outcomes) return Fail(outcomes.error());

  RememberingScu scu;
  Address(scu, peer);
  scu.setDecompressionMode(DcmStorageSCU::DM_never);
  scu.setHaltOnInvalidFileMode(OFFalse);
  scu.setHaltOnUnsuccessfulStoreMode(OFFalse);
  for (const std::filesystem::path& path : files) {
    if (const auto added = scu.addDicomFile(path.c_str(), ERM_fileOnly); added.bad()) {
      return Fail(ErrorCode::kBadFile, path.string() + " cannot be sent: " + added.text() + "; nothing was sent");
    }
  }
  std::optional<OFCondition> broken;
  bool associated = false;
  // One association offers at most 128 kinds; the loop ends when nothing is left to be offered.
  while (scu.getNumberOfSOPInstancesToBeSent() > 0) {
    OFCondition condition = scu.addPresentationContexts();
    if (condition == NET_EC_NoPresentationContextsDefined) break;
    if (condition.good()) condition = scu.initNetwork();
    if (condition.good()) condition = scu.negotiateAssociation();
    if (condition.bad()) {
      if (!associated) return Fail(Unreachable(peer, condition));
      broken = condition;
      break;
    }
    associated = true;
    condition = scu.sendSOPInstances();
    scu.releaseAssociation();
    if (condition.bad()) {
      broken = condition;
      break;
    }
  }
  SendReport report{std::move(*outcomes)};
  for (SendOutcome& outcome : report.outcomes) Judge(outcome, scu.answers(), broken ? broken->text() : "");
  return report;
}

}  // namespace striae::dicom
