#include "dicom/detail/modules.h"

#include "dicom/uid.h"

namespace striae::dicom::detail {
namespace {

constexpr const char* kLocalScheme = "99STRIAE";

/// Device serial numbers stand in the objects, and the dates are the true ones: both are said as options.
void PutDeidentification(DatasetWriter& out, bool metadata_stripped) {
  out.Put(DCM_PatientIdentityRemoved, "YES");
  if (!metadata_stripped) {
    out.PutText(DCM_DeidentificationMethod, "Pseudonym given at capture; camera JPEG metadata not cleaned");
    return;
  }
  out.PutCode(DCM_DeidentificationMethodCodeSequence, {"DCM", "113100", "Basic Application Confidentiality Profile"});
  out.PutCode(DCM_DeidentificationMethodCodeSequence,
              {"DCM", "113106", "Retain Longitudinal Temporal Information Full Dates Option"});
  out.PutCode(DCM_DeidentificationMethodCodeSequence, {"DCM", "113109", "Retain Device Identity Option"});
}

void PutStudy(DatasetWriter& out, const SessionContext& context) {
  out.Put(DCM_StudyInstanceUID, StudyUid(context));
  out.PutDateTime(DCM_StudyDate, DCM_StudyTime, context.session.opened_at);
  out.Put(DCM_ReferringPhysicianName, "").Put(DCM_AccessionNumber, "");
  out.Put(DCM_StudyID, context.session.id.ToString().substr(0, 8));
  out.PutText(DCM_StudyDescription, context.study.protocol + " " + context.visit.name);
  out.PutText(DCM_ClinicalTrialTimePointID, context.visit.name);
}

void PutSeries(DatasetWriter& out, const SessionContext& context, const SeriesFacts& series) {
  out.Put(DCM_Modality, series.modality).Put(DCM_SeriesInstanceUID, series.uid);
  out.Put(DCM_SeriesNumber, std::to_string(series.number));
  out.PutDateTime(DCM_SeriesDate, DCM_SeriesTime, context.session.opened_at);
  out.PutText(DCM_SeriesDescription, series.description);
  out.PutText(DCM_ClinicalTrialCoordinatingCenterName, context.study.coordinating_centre);
}

void PutEquipment(DatasetWriter& out, const Equipment& equipment) {
  out.PutText(DCM_Manufacturer, equipment.manufacturer);
  out.PutText(DCM_ManufacturerModelName, equipment.model);
  out.PutText(DCM_DeviceSerialNumber, equipment.serial);
  if (!equipment.software.empty()) out.PutText(DCM_SoftwareVersions, equipment.software);
}

}  // namespace

Equipment StriaeEquipment(const SessionContext& context, const std::string& software_version) {
  return {"Striae", "Striae", context.device.serial.empty() ? "unknown" : context.device.serial, software_version};
}

Status CheckContext(const SessionContext& context) {
  if (auto dictionary = PrepareDcmtk(); !dictionary) return dictionary;
  const std::string& pseudonym = context.subject.pseudonym;
  if (pseudonym.empty() || pseudonym.size() > 64 || CleanText(pseudonym, 64) != pseudonym ||
      pseudonym.find_first_of("^=") != std::string::npos) {
    return Fail(ErrorCode::kUsage, "the pseudonym \"" + pseudonym +
                                       "\" cannot be a DICOM Patient ID: it must have 1 to 64 characters without "
                                       "backslash, ^ or =");
  }
  // Sponsor Name and Protocol ID are type 1 in every object (PS3.3 C.7.1.3).
  if (CleanText(context.study.sponsor, 64).empty() || CleanText(context.study.protocol, 64).empty()) {
    return Fail(ErrorCode::kRecordRefused, "the study needs a sponsor and a protocol number before it goes to DICOM");
  }
  return {};
}

void PutSubject(DatasetWriter& out, const SessionContext& context) {
  out.Put(DCM_PatientName, context.subject.pseudonym + "^").Put(DCM_PatientID, context.subject.pseudonym);
  out.Put(DCM_PatientBirthDate, "").Put(DCM_PatientSex, "");
  PutDeidentification(out, context.strip_jpeg_metadata);
  out.Put(DCM_LongitudinalTemporalInformationModified, "UNMODIFIED");
  out.PutText(DCM_ClinicalTrialSponsorName, context.study.sponsor);
  out.PutText(DCM_ClinicalTrialProtocolID, context.study.protocol);
  out.PutText(DCM_ClinicalTrialProtocolName, context.study.title);
  out.PutText(DCM_ClinicalTrialSiteID, context.site.code);
  out.PutText(DCM_ClinicalTrialSiteName, context.site.name);
  out.Put(DCM_ClinicalTrialSubjectID, context.subject.pseudonym);
}

void PutCommon(DatasetWriter& out, const SessionContext& context, const SeriesFacts& series, const Equipment& equipment,
               const std::string& sop_class_uid) {
  out.Put(DCM_SpecificCharacterSet, "ISO_IR 192").Put(DCM_SOPClassUID, sop_class_uid);
  out.Put(DCM_TimezoneOffsetFromUTC, "+0000");
  PutSubject(out, context);
  PutStudy(out, context);
  PutSeries(out, context, series);
  PutEquipment(out, equipment);
}

Code LocalCode(const std::string& value, const std::string& meaning) { return {kLocalScheme, value, meaning}; }

void PutLocalCodingScheme(DatasetWriter& out) {
  out.Item(DCM_CodingSchemeIdentificationSequence, [](DatasetWriter& item) {
    item.Put(DCM_CodingSchemeDesignator, kLocalScheme)
        .Put(DCM_CodingSchemeUID, UidOfName("coding scheme"))
        .Put(DCM_CodingSchemeName, "Striae local codes")
        .Put(DCM_CodingSchemeResponsibleOrganization, "Striae");
  });
}

}  // namespace striae::dicom::detail
