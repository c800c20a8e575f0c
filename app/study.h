// Opening the study that a command works on, and what store/ must not draw itself: time, user and ids.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "app/command.h"
#include "core/id.h"
#include "store/record.h"

namespace striae::app {

/// Says who uses the program from here on (--user); stands above STRIAE_USER and the login name.
void ActAs(const std::string& user);

/// Now (the machine's clock), who (--user, else STRIAE_USER, else the login name), and where. Draw one for every
/// change.
store::Stamp NewStamp();

/// A version 4 UUID from the system's random generator.
Uuid NewUuid();
template <typename IdType>
IdType NewId() {
  return IdType(NewUuid());
}

/// The study in -C DIR, or in the current folder. Says so when another program's writing makes this one wait.
Result<store::Record> OpenStudy(const Context& context);

/// The same, or as it stood at an instant (ISO 8601, UTC) where one is given: read-only.
Result<store::Record> OpenStudyAsOf(const Context& context, const std::string& utc);

/// The id of what `text` names (as for Record::Find), which must be an `entity`: kNotFound with `advice` otherwise.
template <typename IdType>
Result<IdType> FindId(store::Record& record, const std::string& text, const std::string& entity,
                      const std::string& advice) {
  const auto found = record.Find(text);
  if (!found) return Fail(found.error());
  if (found->entity != entity) {
    return Fail(ErrorCode::kNotFound, "'" + text.substr(0, 40) + "' is the id of: " + found->entity + "; " + advice);
  }
  return IdType::Parse(found->id);
}
/// The study's own id, where a person says "study", else as Record::Find.
Result<store::Record::Found> FindTarget(store::Record& record, const std::string& text);

/// A session's id as typed: kNotFound, with what to do, when it cannot be one.
Result<SessionId> ParseSessionId(const std::string& text);
/// By a capture's id, its first eight or more characters, or its photograph's SHA-256.
Result<Capture> FindCapture(store::Record& record, const std::string& text);

}  // namespace striae::app
