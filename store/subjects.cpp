// Subjects, their consent and their visits.
#include "store/detail/codec.h"
#include "store/detail/read.h"
#include "store/detail/words.h"
#include "store/pseudonym.h"

namespace striae::store {
namespace {

constexpr std::size_t kLongestPseudonym = 32;

/// Letters, digits and a few signs only: a pseudonym stands in file names, DICOM ids and tables, and a name with its
/// space or comma does not pass by mistake.
void RefuseBadPseudonym(const std::string& pseudonym) {
  bool good = !pseudonym.empty() && pseudonym.size() <= kLongestPseudonym;
  for (const char c : pseudonym) {
    const bool letter = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    good = good && (letter || c == '-' || c == '_' || c == '.');
  }
  if (!good) {
    Refuse(ErrorCode::kUsage, "'" + pseudonym.substr(0, 40) +
                                  "' is no pseudonym; use 1 to 32 letters, digits, '-', '_' or '.', and never a name");
  }
}

void AddConsent(Change& change, Database& database, const SubjectId& subject, const char* kind, const Date& date,
                const std::string& reason) {
  const std::string key = subject.ToString();
  const auto number = detail::NextNumber(database, "consent", "subject_id", key);
  // The date is part of the id, so that two sites' entries stay apart when their copies are united.
  const Uuid id = detail::UuidFrom({"consent", key, std::to_string(number), kind, date.ToString()});
  change.Insert("consent",
                {{"id", ToValue(id.ToString())},
                 {"subject_id", ToValue(key)},
                 {"number", number},
                 {"kind", ToValue(kind)},
                 {"date", ToValue(date)}},
                reason);
}

}  // namespace

Status Record::AddSubject(const Subject& subject, const Stamp& stamp) {
  return Guarded([&] {
    RefuseBadPseudonym(subject.pseudonym);
    Database& database = impl_->database;
    Change change(database, stamp);
    const Study study = detail::Unwrap(GetStudy());
    detail::Unwrap(CheckPseudonym(subject.pseudonym, study.subject_pattern, study.check_digit));
    if (database.Count("SELECT count(*) FROM subject WHERE pseudonym = ? COLLATE NOCASE", subject.pseudonym) != 0) {
      Refuse(ErrorCode::kRecordRefused,
             "subject " + subject.pseudonym + " is in this study already; choose another pseudonym");
    }
    if (database.Count("SELECT count(*) FROM site WHERE id = ?", subject.site) != 1) {
      Refuse(ErrorCode::kNotFound, "no site " + subject.site.ToString() + " in this study; see 'striae status'");
    }
    change.Insert(
        "subject",
        {{"id", ToValue(subject.id)}, {"pseudonym", ToValue(subject.pseudonym)}, {"site_id", ToValue(subject.site)}});
    change.Commit();
  });
}

Result<std::vector<Subject>> Record::Subjects() {
  return Guarded([&] {
    return impl_->database.Rows(std::string(detail::kSubjects) + " ORDER BY pseudonym", detail::ReadSubject);
  });
}

Result<Subject> Record::SubjectById(const SubjectId& id) {
  return Guarded([&] { return detail::GetSubject(impl_->database, id); });
}

Result<Subject> Record::SubjectByPseudonym(std::string_view pseudonym) {
  return Guarded([&] {
    auto subject =
        impl_->database.One(std::string(detail::kSubjects) + " WHERE pseudonym = ?", detail::ReadSubject, pseudonym);
    if (!subject) {
      Refuse(ErrorCode::kNotFound,
             "no subject '" + std::string(pseudonym.substr(0, 40)) +
                 "' in this study; see 'striae subject list', or add it with 'striae subject add'");
    }
    return *std::move(subject);
  });
}

Status Record::GiveConsent(const SubjectId& id, const Date& given, const Stamp& stamp) {
  return Guarded([&] {
    Database& database = impl_->database;
    Change change(database, stamp);
    const Subject subject = detail::GetSubject(database, id);
    if (subject.HasActiveConsent()) {
      if (*subject.consent_given == given) return;
      Refuse(ErrorCode::kRecordRefused, "consent of " + subject.pseudonym + " is active since " +
                                            subject.consent_given->ToString() + "; nothing was changed");
    }
    if (subject.consent_withdrawn && given < *subject.consent_withdrawn) {
      Refuse(ErrorCode::kRecordRefused, "consent of " + subject.pseudonym + " was withdrawn on " +
                                            subject.consent_withdrawn->ToString() +
                                            "; a new consent must be of that day or later");
    }
    AddConsent(change, database, id, "given", given, "");
    change.Commit();
  });
}

Status Record::WithdrawConsent(const SubjectId& id, const Date& withdrawn, const std::string& reason,
                               const Stamp& stamp) {
  return Guarded([&] {
    Database& database = impl_->database;
    Change change(database, stamp);
    const Subject subject = detail::GetSubject(database, id);
    if (!subject.consent_given) {
      Refuse(ErrorCode::kRecordRefused, subject.pseudonym + " has given no consent that could be withdrawn");
    }
    if (subject.consent_withdrawn) {
      if (*subject.consent_withdrawn == withdrawn) return;
      Refuse(ErrorCode::kRecordRefused, "consent of " + subject.pseudonym + " was withdrawn on " +
                                            subject.consent_withdrawn->ToString() + " already; nothing was changed");
    }
    if (withdrawn < *subject.consent_given) {
      Refuse(ErrorCode::kRecordRefused, "consent of " + subject.pseudonym + " was given on " +
                                            subject.consent_given->ToString() + "; it cannot be withdrawn before");
    }
    AddConsent(change, database, id, "withdrawn", withdrawn, reason);
    change.Commit();
  });
}

Result<std::vector<Visit>> Record::Visits(const SubjectId& subject) {
  return Guarded([&] {
    detail::GetSubject(impl_->database, subject);
    return impl_->database.Rows(std::string(detail::kVisits) + " WHERE subject_id = ? ORDER BY name", detail::ReadVisit,
                                subject);
  });
}

Result<Visit> Record::VisitById(const VisitId& id) {
  return Guarded([&] { return detail::GetVisit(impl_->database, id); });
}

}  // namespace striae::store
