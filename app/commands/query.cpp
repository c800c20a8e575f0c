// `striae query open|answer|close|reopen|list`: questions about the data.
#include "app/names.h"
#include "app/study.h"
#include "store/annotations.h"
#include "store/json.h"

namespace striae::app {
namespace {

struct Options {
  std::string target, text;
  bool all = false;
};

Status Open(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto target = FindTarget(*record, options.target);
  if (!target) return Fail(target.error());
  const auto id = NewId<store::QueryId>();
  const Status opened = store::OpenQuery(*record, id, *target, options.text, NewStamp());
  if (!opened) return Fail(opened.error(), "opening a query");
  run.Output({{"id", id.ToString()}, {"state", "open"}}, id.ToString());
  return {};
}

Status Step(Context& run, const Options& options, store::QueryState next) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto id = FindId<store::QueryId>(*record, options.target, "data_query", "see 'striae query list'");
  if (!id) return Fail(id.error());
  const Status done = store::StepQuery(*record, *id, next, options.text, NewStamp());
  if (!done) return Fail(done.error(), "query " + id->ToString());
  run.Output({{"id", id->ToString()}, {"state", ToString(next)}}, "query is " + std::string(ToString(next)));
  return {};
}

Status List(Context& run, const Options& options) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto queries = store::Queries(*record, options.all);
  if (!queries) return Fail(queries.error());
  nlohmann::json list = nlohmann::json::array();
  std::string text;
  for (const store::DataQuery& query : *queries) {
    list.push_back(store::ToJson(query));
    const auto about = NameOf(*record, query.about);
    if (!about) return Fail(about.error());
    text += (text.empty() ? "" : "\n") + query.id.ToString() + "  " + std::string(ToString(query.state)) + "  " +
            *about + "  " + query.by + ": " + query.text;
    for (const store::QueryStep& step : query.steps) {
      text += "\n    " + std::string(ToString(step.state)) + " by " + step.by + ": " + step.text;
    }
  }
  run.Output({{"queries", list}}, text.empty() ? "no open queries" : text);
  return {};
}

}  // namespace

void AddCommand_query(CLI::App& root, Context& context) {
  using State = store::QueryState;
  CLI::App& group = Group(root, "query", "Questions about the data, their answers and their closing");
  auto options = std::make_shared<Options>();
  CLI::App* open = AddCommand(group, context, "open", "Ask about anything in the record",
                              "striae -C trial query open S001 --text \"Is the date of consent right?\"");
  open->add_option("TARGET", options->target, "A pseudonym or an id")->required();
  open->add_option("--text", options->text, "The question")->required();
  OnRun(open, context, [options](Context& run) { return Open(run, *options); });
  const auto add_step = [&](const char* name, const char* description, State next) {
    CLI::App* step = AddCommand(group, context, name, description,
                                std::string("striae -C trial query ") + name + " 3f0c4f5e --text \"checked, it is\"");
    step->add_option("QUERY", options->target, "The query's id")->required();
    step->add_option("--text", options->text, "What is said")->required();
    OnRun(step, context, [options, next](Context& run) { return Step(run, *options, next); });
  };
  add_step("answer", "Answer an open query", State::kAnswered);
  add_step("close", "Close a query", State::kClosed);
  add_step("reopen", "Open an answered or closed query again", State::kOpen);
  CLI::App* list =
      AddCommand(group, context, "list", "List the queries that are not closed", "striae -C trial query list");
  list->add_flag("--all", options->all, "Closed ones too");
  OnRun(list, context, [options](Context& run) { return List(run, *options); });
}

}  // namespace striae::app
