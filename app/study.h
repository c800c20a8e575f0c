// Opening the study that a command works on, and what store/ must not draw itself: time, user and ids.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "app/command.h"
#include "core/id.h"
#include "store/record.h"

namespace striae::app {

/// Now (the machine's clock), who (STRIAE_USER, else the login name), and where. Draw one for every change.
store::Stamp NewStamp();

/// A version 4 UUID from the system's random generator.
Uuid NewUuid();
template <typename IdType>
IdType NewId() {
  return IdType(NewUuid());
}

/// The study in -C DIR, or in the current folder.
Result<store::Record> OpenStudy(const Context& context);

/// A session's id as typed: kNotFound, with what to do, when it cannot be one.
Result<SessionId> ParseSessionId(const std::string& text);
/// By a capture's id, its first eight or more characters, or its photograph's SHA-256.
Result<Capture> FindCapture(store::Record& record, const std::string& text);

}  // namespace striae::app
