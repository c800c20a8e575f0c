#include "app/listing.h"

#include <array>

#include "core/result.h"

namespace striae::app {

Listing::Listing(const Context& context, std::string_view name, std::string_view empty)
    : json_(context.json), empty_(empty), file_(std::tmpfile()) {
  good_ = file_ != nullptr;
  if (json_) Write("{\"" + std::string(name) + "\": [");
}

void Listing::Write(std::string_view text) {
  good_ = good_ && std::fwrite(text.data(), 1, text.size(), file_.get()) == text.size();
}

void Listing::Add(std::string_view entry) {
  if (json_) Write(any_ ? ",\n" : "\n");
  Write(entry);
  if (!json_) Write("\n");
  any_ = true;
}

Status Listing::Print() {
  if (json_) Write(any_ ? "\n]}\n" : "]}\n");
  if (!json_ && !any_) Write(empty_ + "\n");
  good_ = good_ && std::fflush(file_.get()) == 0 && std::fseek(file_.get(), 0, SEEK_SET) == 0;
  if (!good_) {
    return Fail(ErrorCode::kIo, "the list could not be kept in a temporary file; make room on its disk (TMPDIR)");
  }
  std::array<char, 65536> block;
  while (const std::size_t size = std::fread(block.data(), 1, block.size(), file_.get())) {
    if (std::fwrite(block.data(), 1, size, stdout) != size) break;  // whoever reads has gone
  }
  return {};
}

}  // namespace striae::app
