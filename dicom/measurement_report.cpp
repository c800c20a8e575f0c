#include "dicom/measurement_report.h"

#include <algorithm>
#include <set>

#include <dcmtk/config/osconfig.h>
// osconfig.h comes first: DCMTK's other headers need it.
#include <dcmtk/dcmsr/dsrdoc.h>

#include "dicom/body_site.h"
#include "dicom/check.h"
#include "dicom/detail/dataset.h"
#include "dicom/detail/encode.h"
#include "dicom/detail/modules.h"
#include "dicom/detail/sr_tree.h"
#include "dicom/uid.h"

namespace striae::dicom {
namespace {

using detail::DatasetWriter;
using detail::SrTree;

constexpr auto kContains = DSRTypes::RT_contains;
constexpr auto kObsContext = DSRTypes::RT_hasObsContext;
constexpr auto kConceptMod = DSRTypes::RT_hasConceptMod;
constexpr auto kInferredFrom = DSRTypes::RT_inferredFrom;
constexpr auto kProperties = DSRTypes::RT_hasProperties;

Code Dcm(const char* value, const char* meaning) { return {"DCM", value, meaning}; }
Code Sct(const char* value, const char* meaning) { return {"SCT", value, meaning}; }

std::string TrackingName(const Capture& capture, const AnalysisReport& report) {
  return capture.role.kind == CaptureRole::Kind::kWound ? "wound " + capture.role.label : report.analysis;
}

/// TID 1001: the observer is a device, named by the rig.
void PutObserver(SrTree& tree, const detail::Equipment& striae) {
  tree.AddCode(kObsContext, Dcm("121005", "Observer Type"), Dcm("121007", "Device"))
      .Uid(kObsContext, Dcm("121012", "Device Observer UID"), UidOfName("device/" + striae.serial))
      .Text(kObsContext, Dcm("121013", "Device Observer Name"), striae.model)
      .Text(kObsContext, Dcm("121014", "Device Observer Manufacturer"), striae.manufacturer)
      .Text(kObsContext, Dcm("121015", "Device Observer Model Name"), striae.model)
      .Text(kObsContext, Dcm("121016", "Device Observer Serial Number"), striae.serial);
}

/// TID 1419/300: one number with its meaning, algorithm, uncertainty and sources.
void PutMeasurement(SrTree& tree, const Measurement& measurement, const MeasurementGroup& group) {
  tree.Number(kContains, measurement.code, measurement.value, measurement.unit).Down();
  for (const Code& equivalent : measurement.equivalents) {
    tree.AddCode(kConceptMod, Dcm("121050", "Equivalent Meaning of Concept Name"), equivalent);
  }
  if (measurement.name.ends_with("_max")) {
    tree.AddCode(kConceptMod, Dcm("121401", "Derivation"), Sct("56851009", "Maximum"));
  }
  // TID 4019 stands below each number: several numbers of one group may come to have different methods.
  tree.Text(kConceptMod, Dcm("111001", "Algorithm Name"), "Striae " + group.report.analysis + "/" + measurement.name)
      .Text(kConceptMod, Dcm("111003", "Algorithm Version"),
            group.report.version + " (Striae " + group.report.provenance.version + ")");
  tree.Number(kInferredFrom, Sct("371884006", "+/-, range of measurement uncertainty"), measurement.uncertainty,
              measurement.unit);
  for (const ObjectReference& source : group.evidence) {
    tree.Reference(kInferredFrom, Dcm("121112", "Source of Measurement"), source);
  }
  if (measurement.status == Measurement::Status::kFlagged) {
    tree.Text(kProperties, Dcm("121106", "Comment"), "Flagged: " + measurement.reason);
  }
  tree.Up();
}

/// Head angles have no public codes, so their definition stands in words; whose axes they are differs by subject.
std::string HeadDefinition(const AnalysisReport& report) {
  std::string text =
      "R = R_torso^T R_head takes a head vector of the neutral pose to this one; angles in the sequence Z-X-Y; "
      "rotation "
      "positive to the subject's left, flexion positive chin towards chest, tilt positive to the subject's right";
  const auto axes = report.details.find("axes_source");
  if (axes != report.details.end() && axes->is_string()) text += "; axes: " + axes->get<std::string>();
  return text;
}

/// TID 1501.
void PutGroup(SrTree& tree, const SessionContext& context, const MeasurementGroup& group) {
  const std::string name = TrackingName(group.capture, group.report);
  tree.Container(Dcm("125007", "Measurement Group"), "1501");
  tree.Text(kObsContext, Dcm("112039", "Tracking Identifier"), name)
      .Uid(kObsContext, Dcm("112040", "Tracking Unique Identifier"),
           UidOfName("tracking/" + context.subject.id.ToString() + "/" + name));
  const bool wound = group.report.analysis == "wound";
  if (wound) tree.AddCode(kContains, Dcm("121071", "Finding"), Sct("416462003", "Wound"));
  tree.Text(kObsContext, {"UMLS", "C2348792", "Time Point"}, context.visit.name);
  if (const auto site = wound ? SiteOf(group.capture) : FindBodySite("head")) {
    tree.AddCode(kConceptMod, Sct("363698007", "Finding Site"), site->code);
    if (const auto side = LateralityCode(group.capture.laterality); side && wound) {
      tree.Down().AddCode(kConceptMod, Sct("272741003", "Laterality"), *side).Up();
    }
  }
  for (const Measurement& measurement : group.report.measurements) PutMeasurement(tree, measurement, group);
  if (group.report.analysis == "head") {
    tree.Text(kContains, Dcm("121106", "Comment"), HeadDefinition(group.report));
  }
  tree.Up();
}

Status BuildTree(DSRDocumentTree& content, const SessionContext& context, const std::vector<MeasurementGroup>& groups,
                 const detail::Equipment& striae) {
  SrTree tree(content, Dcm("126000", "Imaging Measurement Report"), "1500");
  tree.AddCode(kConceptMod, Dcm("121049", "Language of Content Item and Descendants"), {"RFC5646", "en", "English"});
  PutObserver(tree, striae);
  tree.AddCode(kConceptMod, Dcm("121058", "Procedure reported"), Sct("363679005", "Imaging procedure"));
  tree.Container(Dcm("126010", "Imaging Measurements"));
  for (const MeasurementGroup& group : groups) PutGroup(tree, context, group);
  tree.Up();
  return tree.status();
}

bool UsesLocalCodes(const std::vector<MeasurementGroup>& groups) {
  const std::string scheme = detail::LocalCode("", "").scheme;
  return std::any_of(groups.begin(), groups.end(), [&scheme](const MeasurementGroup& group) {
    return std::any_of(group.report.measurements.begin(), group.report.measurements.end(),
                       [&scheme](const Measurement& m) { return m.code.scheme == scheme; });
  });
}

/// The document header that DCMTK writes, as far as it knows it; the caller's modules are laid over it afterwards.
Status WriteDocument(DcmDataset& dataset, const SessionContext& context, const std::vector<MeasurementGroup>& groups,
                     const detail::Equipment& striae, UtcTime at, int number) {
  DSRDocument document(DSRTypes::DT_Comprehensive3DSR);
  std::vector<OFCondition> done;
  done.push_back(document.setSpecificCharacterSetType(DSRTypes::CS_UTF8));
  if (auto built = BuildTree(document.getTree(), context, groups, striae); !built) return built;
  std::set<std::string> listed;
  for (const MeasurementGroup& group : groups) {
    for (const ObjectReference& object : group.evidence) {
      if (!listed.insert(object.sop_instance_uid).second) continue;
      auto& evidence = object.study_uid == StudyUid(context) ? document.getCurrentRequestedProcedureEvidence()
                                                             : document.getPertinentOtherEvidence();
      done.push_back(evidence.addItem(object.study_uid.c_str(), object.series_uid.c_str(), object.sop_class_uid.c_str(),
                                      object.sop_instance_uid.c_str()));
    }
  }
  done.push_back(document.setContentDate(detail::DateText(at).c_str()));
  done.push_back(document.setContentTime(detail::TimeText(at).c_str()));
  done.push_back(document.setInstanceNumber(std::to_string(number).c_str()));
  done.push_back(document.completeDocument());
  done.push_back(document.write(dataset));
  const auto bad = std::find_if(done.begin(), done.end(), [](const OFCondition& c) { return c.bad(); });
  if (bad != done.end())
    return Fail(ErrorCode::kInternal, std::string("cannot write the DICOM report: ") + bad->text());
  // DCMTK takes these from the clock and from a random number; Striae's come from the record.
  for (const DcmTagKey& tag : {DCM_InstanceCreationDate, DCM_InstanceCreationTime, DCM_InstanceCreatorUID}) {
    delete dataset.remove(tag);
  }
  return {};
}

}  // namespace

Result<Object> EncodeMeasurements(const SessionContext& context, const std::vector<MeasurementGroup>& groups,
                                  int number) {
  if (auto usable = detail::CheckContext(context); !usable) return Fail(usable.error());
  if (groups.empty()) return Fail(ErrorCode::kUsage, "there are no measurements for a DICOM report");
  UtcTime at = groups.front().made_at;
  for (const MeasurementGroup& group : groups) {
    if (auto fit = CheckReport(group.report, group.evidence); !fit) {
      return Fail(fit.error(), "capture " + group.capture.id.ToString());
    }
    if (group.evidence.front().study_uid != StudyUid(context)) {
      return Fail(ErrorCode::kUsage, "the measurements refer to objects that are not of this session");
    }
    if (group.made_at.unix_ms > at.unix_ms) at = group.made_at;
  }
  const detail::Equipment striae = detail::StriaeEquipment(context, groups.front().report.provenance.version);
  DcmFileFormat file;
  if (auto written = WriteDocument(*file.getDataset(), context, groups, striae, at, number); !written) {
    return Fail(written.error());
  }
  DatasetWriter out(*file.getDataset());
  detail::PutCommon(out, context, {MeasurementSeriesUid(context), "SR", 1000, "Measurements"}, striae,
                    UID_Comprehensive3DSRStorage);
  if (UsesLocalCodes(groups)) detail::PutLocalCodingScheme(out);
  if (!out.status()) return Fail(out.status().error());
  return detail::Finish(ObjectKind::kMeasurements, file, EXS_LittleEndianExplicit);
}

}  // namespace striae::dicom
