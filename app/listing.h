// A list of any length on stdout: entries go to a temporary file as they come and to stdout when all are there, so that
// memory does not grow with the list and nothing is printed when the last entry fails.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "app/command.h"

namespace striae::app {

class Listing {
 public:
  /// With --json the document {"<name>": [entries]}; else their lines, or `empty` where there is none.
  Listing(const Context& context, std::string_view name, std::string_view empty);
  [[nodiscard]] bool json() const { return json_; }
  /// An entry as JSON text with --json, else its line.
  void Add(std::string_view entry);
  /// Prints all; kIo when the temporary file could not hold it. Instead of Context::Output, and as often: once.
  Status Print();

 private:
  void Write(std::string_view text);
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  bool json_, good_, any_ = false;
  std::string empty_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace striae::app
