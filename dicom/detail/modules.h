// The modules that every object of a session has (PS3.3 C.7, C.12): patient, study, series, clinical trial, equipment.
#pragma once

#include <string>

#include "dicom/detail/dataset.h"
#include "dicom/session_context.h"

namespace striae::dicom::detail {

struct SeriesFacts {
  std::string uid;
  std::string modality;
  int number = 1;
  std::string description;
};

/// General Equipment: what made the data.
struct Equipment {
  std::string manufacturer, model, serial, software;  ///< software may be empty where the object is the camera's own
};

/// What analysed and encoded: Striae, of the rig's serial number.
Equipment StriaeEquipment(const SessionContext& context, const std::string& software_version);

/// kUsage where the pseudonym cannot stand in a Patient ID as it is.
Status CheckContext(const SessionContext& context);

/// Patient, Clinical Trial Subject, General Study, Clinical Trial Study, General Series, Clinical Trial Series, General
/// Equipment, SOP Common. The SOP Instance UID is written by Finish (encode.h).
void PutCommon(DatasetWriter& out, const SessionContext& context, const SeriesFacts& series, const Equipment& equipment,
               const std::string& sop_class_uid);

/// Patient and Clinical Trial Subject with the de-identification that the context allows to claim.
void PutSubject(DatasetWriter& out, const SessionContext& context);
/// The coding scheme of codes that no public scheme has.
Code LocalCode(const std::string& value, const std::string& meaning);
void PutLocalCodingScheme(DatasetWriter& out);

}  // namespace striae::dicom::detail
