// What the local names of measurements mean to a reader: label, order in the table, better direction, words.
#pragma once

#include <string>
#include <string_view>

#include "report/subject_report.h"
#include "report/verdict.h"

namespace striae::report {

struct Quantity {
  std::string label;  ///< "95th pct. of depth"
  int order = 0;      ///< place in the table, smallest first; names that are not known come last
  Better better = Better::kNotDefined;
  bool headline = false;  ///< shown large and in the plot
};

/// By the names of CONTRACT; any other name is its own label, with no better direction.
Quantity DescribeQuantity(std::string_view name, HeadGoal goal);

/// A head angle in words, "turned 32 deg to the subject's left", whole degrees; "straight within error" up to 1.96
/// standard uncertainties. Empty for quantities without words. Signs as in CONTRACT: rotation positive to the
/// subject's left, flexion positive chin towards chest, tilt positive to the subject's right.
std::string InWords(std::string_view name, double value, double uncertainty);

}  // namespace striae::report
