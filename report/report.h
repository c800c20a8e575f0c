// One subject on one page: the measurements over the visits with their uncertainty, their change and what it means,
// a plot over real days, the photographs and depth maps, and what is missing.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/result.h"
#include "report/subject_report.h"

namespace striae::report {

/// One self-contained file: inline style, inline SVG, pictures as data URIs, no scripts, no outside references. Every
/// text from the record is escaped. A picture that cannot be decoded is said to be so in its place.
Result<std::string> HtmlReport(const SubjectReport& subject);

/// A4, vector text and plot, embedded fonts. One page as long as the visits fit on it, then as many as they need. The
/// same input gives the same bytes on one installation: the creation date is `generated_at`. kInternal if the PDF
/// library fails.
Result<std::vector<std::uint8_t>> PdfReport(const SubjectReport& subject);

}  // namespace striae::report
