// `striae watch`: photographs that arrive in a folder go into a session as soon as they are complete.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>

#include "acquire/hot_folder.h"
#include "app/intake.h"
#include "app/study.h"
#include "app/tagging.h"

namespace striae::app {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

struct Options {
  TagOptions tag;
  std::filesystem::path folder;
  double seconds = 0;
  int count = 0;
  bool sidecar = false, poll = false;
};

std::atomic<bool> stop_asked{false};

/// Ctrl-C (and the end of the desktop's session) ends the watch after the photograph at hand, and no sooner.
class StopOnSignal {
 public:
  StopOnSignal() {
    stop_asked = false;
    struct sigaction action {};
    action.sa_handler = [](int) { stop_asked = true; };
    ::sigaction(SIGINT, &action, &before_int_);
    ::sigaction(SIGTERM, &action, &before_term_);
  }
  ~StopOnSignal() {
    ::sigaction(SIGINT, &before_int_, nullptr);
    ::sigaction(SIGTERM, &before_term_, nullptr);
  }
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

 private:
  struct sigaction before_int_ {
  }, before_term_{};
};

std::string Announce(store::Record& record, const Options& options, const acquire::CaptureBinding& binding,
                     bool is_told) {
  const auto subject = record.SubjectById(binding.subject);
  return "watching " + options.folder.string() + " for photographs of " +
         (subject ? subject->pseudonym : binding.subject.ToString()) + ", session " + binding.session.ToString() +
         ", as " + binding.role.ToString() + "; Ctrl-C ends" +
         (is_told ? "" : " (this folder tells nothing of itself, it is listed every second)");
}

Status Watch(Context& run, const Options& options) {
  auto tagged = Tag(run, options.tag);
  if (!tagged) return Fail(tagged.error());
  auto& [record, binding, range] = *tagged;
  acquire::HotFolderOptions how;
  how.may_be_told = !options.poll;
  auto folder = acquire::HotFolder::Open(options.folder, binding, how);
  if (!folder) return Fail(folder.error());
  const StopOnSignal signals;
  run.Note(Announce(record, options, binding, folder->IsTold()));
  const auto end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.seconds));
  std::vector<Intake> intakes;
  Status gone;
  int added = 0;
  constexpr milliseconds kPatience{300};  // between two looks at Ctrl-C
  while (!stop_asked && (options.count == 0 || added < options.count)) {
    const auto left = std::chrono::duration_cast<milliseconds>(end - Clock::now());
    if (options.seconds > 0 && left.count() <= 0) break;
    const auto item = folder->Next(options.seconds > 0 ? std::min(left, kPatience) : kPatience);
    if (!item) {
      gone = Fail(item.error());
      break;
    }
    if (!*item) continue;
    intakes.push_back(TakeIn(record, **item, range, Refused::kLeaveAtSource));
    if (options.sidecar) AddSidecar(record, (*item)->origin, intakes.back());
    run.Note(Describe(intakes.back()));
    added += intakes.back().state == Intake::State::kAdded ? 1 : 0;
  }
  auto document = ToJson(binding.session, intakes);
  document["folder"] = options.folder.string();
  if (!gone)
    document["error"] = {{"code", std::string(ToString(gone.error().code))}, {"message", gone.error().message}};
  run.Output(document, std::to_string(added) + " added, " + std::to_string(document["already_there"].get<int>()) +
                           " already there, " + std::to_string(document["failed"].get<int>()) + " failed");
  return gone ? OutcomeOf(intakes) : gone;
}

}  // namespace

void AddCommand_watch(CLI::App& root, Context& context) {
  CLI::App* command = AddCommand(
      root, context, "watch",
      "Bring photographs into a session as they arrive in a folder, those that lie there already included. A file "
      "that\n"
      "is still being written is waited for; one that stays broken for ten seconds goes to the quarantine. Ends with\n"
      "Ctrl-C, after --for SECONDS or after --count photographs.",
      "striae -C trial watch --session 3f0c2f6e-8f4f-4c1e-9d39-5d2f3f1f9a11 /media/incoming --as wound:W1");
  auto options = std::make_shared<Options>();
  AddTagOptions(*command, options->tag);
  command->add_option("DIR", options->folder, "The folder; folders below it count as well")->required();
  command->add_option("--for", options->seconds, "End after so many seconds")
      ->check(CLI::PositiveNumber)
      ->type_name("SECONDS");
  command->add_option("--count", options->count, "End when so many photographs have been added")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  command->add_flag("--poll", options->poll, "List the folder every second instead of waiting to be told of a change");
  command->add_flag("--sidecar", options->sidecar, "Write FILE.xmp beside each photograph, as for import");
  OnRun(command, context, [options](Context& run) { return Watch(run, *options); });
}

}  // namespace striae::app
