// Text into HTML, SVG and Pango markup, where a hostile name must stay text.
#pragma once

#include <string>
#include <string_view>

namespace striae::report::detail {

/// Valid UTF-8 only (other bytes become U+FFFD), control characters become spaces, & < > " are escaped. Attributes
/// are always written in double quotes, so the apostrophe stays readable.
std::string Escape(std::string_view text);

/// The first half of Escape: valid UTF-8 without control characters, nothing escaped.
std::string CleanText(std::string_view text);

}  // namespace striae::report::detail
