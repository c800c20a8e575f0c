#include "app/sidecars.h"

#include "acquire/sidecar.h"
#include "app/io/files.h"

namespace striae::app {

Status WriteSidecar(store::Record& record, const Capture& capture, const std::filesystem::path& photograph) {
  const auto study = record.GetStudy();
  if (!study) return Fail(study.error());
  const auto session = record.SessionById(capture.session);
  if (!session) return Fail(session.error());
  const auto subject = record.SubjectById(session->subject);
  if (!subject) return Fail(subject.error());
  const auto visit = record.VisitById(session->visit);
  if (!visit) return Fail(visit.error());
  const auto text = acquire::MakeSidecar(capture, {study->protocol, subject->pseudonym, visit->name});
  if (!text) return Fail(text.error());
  const auto path = acquire::SidecarPath(photograph);
  std::error_code code;
  if (std::filesystem::exists(path, code)) {
    const auto there = ReadText(path);
    if (!there) return Fail(there.error());
    if (*there == *text) return {};
    if (!acquire::IsOwnSidecar(*there)) {
      return Fail(ErrorCode::kRecordRefused,
                  path.string() +
                      " is another program's and was left as it is; the photograph is in the "
                      "record all the same");
    }
  }
  return WriteText(path, *text);
}

}  // namespace striae::app
