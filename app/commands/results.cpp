// `striae results`: the study's measurements.
#include "store/results.h"

#include <cstdio>

#include "app/listing.h"
#include "app/names.h"
#include "app/study.h"

namespace striae::app {
namespace {

struct Options {
  std::string subject, session, as_of;
  bool all = false;
};

Result<store::ResultFilter> FilterOf(store::Record& record, const Options& options) {
  store::ResultFilter filter;
  filter.with_superseded = options.all;
  if (!options.subject.empty()) {
    const auto subject = record.SubjectByPseudonym(options.subject);
    if (!subject) return Fail(subject.error());
    filter.subject = subject->id;
  }
  if (!options.session.empty()) {
    const auto session = FindSession(record, options.session);
    if (!session) return Fail(session.error());
    filter.session = session->id;
  }
  return filter;
}

std::string LineOf(const store::ResultRow& row) {
  const Measurement& m = row.measurement;
  char numbers[96];
  std::snprintf(numbers, sizeof numbers, "%12.4g +- %-10.2g %-4s", m.value, m.uncertainty, m.unit.c_str());
  std::string line = row.subject.pseudonym + "  " + row.visit.name + "  " + row.role.ToString() + "  " + m.name;
  line.resize(std::max<std::size_t>(line.size() + 1, 48), ' ');
  line += numbers;
  if (m.status == Measurement::Status::kFlagged) line += "  flagged: " + m.reason;
  if (row.excluded) line += "  excluded: " + *row.excluded;
  if (row.stale) line += "  stale: reassigned since, process it again";
  if (row.superseded) line += "  (superseded)";
  return line;
}

Status Print(Context& run, const Options& options) {
  auto record = OpenStudyAsOf(run, options.as_of);
  if (!record) return Fail(record.error());
  const auto filter = FilterOf(*record, options);
  if (!filter) return Fail(filter.error());
  Listing listing(run, "measurements", "no measurements; 'striae status' says what is pending");
  const Status read = store::EachResult(*record, *filter, [&](const store::ResultRow& row, const std::string& json) {
    listing.Add(listing.json() ? json : LineOf(row));
  });
  return read ? listing.Print() : read;
}

}  // namespace

void AddCommand_results(CLI::App& root, Context& context) {
  CLI::App* command = AddCommand(root, context, "results", "Print the measurements with their standard uncertainty",
                                 "striae -C trial results --subject S001 --json");
  auto options = std::make_shared<Options>();
  command->add_option("--subject", options->subject, "Only those of this subject");
  command->add_option("--session", options->session, "Only those of this session");
  command->add_flag("--all", options->all, "Superseded measurements too");
  command->add_option("--as-of", options->as_of, "As the study stood then, UTC: 2026-05-04T12:00:00Z");
  OnRun(command, context, [options](Context& run) { return Print(run, *options); });
}

}  // namespace striae::app
