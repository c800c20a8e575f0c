// The report before any layout: what is said, in which order, already as text. HTML and PDF only set it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "report/drawing.h"
#include "report/subject_report.h"
#include "report/verdict.h"

namespace striae::report {

struct Field {
  std::string label;
  std::vector<std::string> parts;  ///< set with "; " between them, lines broken between parts rather than inside one
};

/// One visit's value of one quantity. Every text is empty where there is nothing to say.
struct Cell {
  std::string value;   ///< "0.713 ± 0.052"; "no value"
  std::string flag;    ///< "a": the letter under which the column's notes give the reason
  std::string words;   ///< "turned 32 deg to the subject's left"
  std::string change;  ///< "−0.42 (−37 %)"
  std::string limit;   ///< "limit 0.14"
  bool has_verdict = false;
  Verdict verdict = Verdict::kNotAssessable;
  std::string verdict_reason;  ///< why it is not assessable
};

struct Row {
  std::string label, unit;
  std::vector<Cell> cells;  ///< one a column
};

struct Column {
  std::string visit, date, day;    ///< "V1", "2026-05-04", "day 0"
  std::string status;              ///< "in window"
  std::vector<std::string> notes;  ///< "flag a: no healthy skin at 34 % of the boundary"
};

/// A number shown large: the newest value of a headline quantity.
struct Headline {
  std::string label, unit, when;  ///< when: "V3, day 28"
  Cell cell;
};

struct PictureCard {
  std::string caption;  ///< "V1 · 2026-05-04 · day 0"
  std::string photograph_alt, depth_alt;
  std::vector<std::uint8_t> photograph, depth_map;  ///< as in CaptureEntry
};

/// Everything measured of one thing: a wound, or the k-th head pose of each visit.
struct Section {
  std::string title;  ///< "Wound W1, left calf"
  std::vector<Headline> headlines;
  std::vector<Column> columns;
  std::vector<Row> rows;
  std::vector<std::string> notes;  ///< about the whole section
  std::vector<Drawing> plots;      ///< side by side
  std::string plot_caption;
  std::vector<PictureCard> pictures;
};

struct Page {
  std::string title, subtitle;
  std::vector<Field> header;
  std::vector<std::string> warnings;  ///< consent withdrawn, ...
  std::vector<Section> sections;
  std::vector<std::string> missing;  ///< failed and missing captures and visits, with reasons
  std::vector<std::string> footer;   ///< how the figures are made
  std::string generated;             ///< "2026-05-04 07:08 UTC by striae 0.1.0"
};

/// Pure: the same input gives the same page. Visits are ordered by date; repeated captures of one wound in one session
/// become their mean (its uncertainty: the larger of the root mean square of theirs and the standard error of the
/// mean, since repeats share the rig's errors), flagged repeats left out and named unless all are flagged.
Page BuildPage(const SubjectReport& subject);

}  // namespace striae::report
