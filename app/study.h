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

/// Ids and dates as typed on the command line: kUsage with the option's name when they cannot be meant.
Result<SessionId> ParseSessionId(const std::string& text);
/// A capture's id, or its first eight or more characters.
Result<Capture> FindCapture(store::Record& record, const std::string& text);

}  // namespace striae::app
