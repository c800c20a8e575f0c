#include "report/verdict.h"

#include <cmath>

namespace striae::report {
namespace {

constexpr double kTwoSided95 = 1.96;

bool ComparesSizes(Better better) { return better == Better::kSmallerSize || better == Better::kLargerSize; }

std::string WhyNotAssessable(const Reading& first, const Reading& now, Better better) {
  if (now.flagged) return "flagged";
  if (first.flagged) return "first flagged";
  if (first.method != now.method) return "different methods: " + first.method + ", " + now.method;
  if (!(first.uncertainty > 0) || !(now.uncertainty > 0)) return "uncertainty not known";
  if (better == Better::kNotDefined) return "no better direction defined";
  return {};
}

}  // namespace

std::string_view ToString(Verdict verdict) {
  switch (verdict) {
    case Verdict::kImproved:
      return "improved";
    case Verdict::kWorse:
      return "worse";
    case Verdict::kWithinError:
      return "within error";
    case Verdict::kNotAssessable:
      break;
  }
  return "not assessable";
}

Comparison Compare(const Reading& first, const Reading& now, Better better) {
  Comparison result;
  if (first.unit != now.unit) {
    result.reason = "different units: " + first.unit + ", " + now.unit;
    return result;
  }
  const bool sizes = ComparesSizes(better);
  const double before = sizes ? std::abs(first.value) : first.value;
  const double after = sizes ? std::abs(now.value) : now.value;
  result.change = after - before;
  result.change_uncertainty = std::hypot(first.uncertainty, now.uncertainty);
  result.limit = kTwoSided95 * result.change_uncertainty;
  if (std::abs(before) > kTwoSided95 * first.uncertainty) result.percent = 100 * *result.change / std::abs(before);
  result.reason = WhyNotAssessable(first, now, better);
  if (!result.reason.empty()) return result;

  if (std::abs(*result.change) <= result.limit) {
    if (sizes && std::abs(now.value - first.value) > result.limit) {
      result.reason = "now to the other side";
      return result;
    }
    result.verdict = Verdict::kWithinError;
    return result;
  }
  const bool smaller_is_better = better == Better::kSmaller || better == Better::kSmallerSize;
  result.verdict = (*result.change < 0) == smaller_is_better ? Verdict::kImproved : Verdict::kWorse;
  return result;
}

}  // namespace striae::report
