// `striae capture`: photographs through the cable, tagged with subject and session before the shutter.
#include <memory>
#include <string>
#include <vector>

#include "acquire/tether.h"
#include "app/command.h"
#include "app/intake.h"
#include "app/tagging.h"

namespace striae::app {
namespace {

struct Options {
  TagOptions tag;
  std::string port;
  int shots = 1;
};

std::string AnnounceSubject(store::Record& record, const acquire::CaptureBinding& binding) {
  const auto subject = record.SubjectById(binding.subject);
  const std::string name = subject ? subject->pseudonym : binding.subject.ToString();
  return "taking photographs of " + name + " in session " + binding.session.ToString() + " as " +
         binding.role.ToString();
}

Status Capture(Context& context, const Options& options) {
  auto tagged = Tag(context, options.tag);
  if (!tagged) return Fail(tagged.error());
  auto& [record, binding, range] = *tagged;
  context.Note(AnnounceSubject(record, binding));

  acquire::TetherOptions tether;
  tether.port = options.port;
  acquire::TetherSource source(tether, binding, options.shots);
  std::vector<Intake> intakes;
  Status camera;
  while (true) {
    const auto item = source.Next();
    if (!item) camera = Fail(item.error());
    if (!item || !*item) break;
    intakes.push_back(TakeIn(record, **item, range, Refused::kQuarantine));
    context.Note(Describe(intakes.back()));
  }
  auto document = ToJson(binding.session, intakes);
  if (!camera) {
    document["error"] = {{"code", std::string(ToString(camera.error().code))}, {"message", camera.error().message}};
  }
  context.Output(document, std::to_string(document["added"].get<int>()) + " of " + std::to_string(options.shots) +
                               " photographs taken");
  return camera ? OutcomeOf(intakes) : camera;
}

}  // namespace

void AddCommand_capture(CLI::App& root, Context& context) {
  CLI::App* command =
      AddCommand(root, context, "capture",
                 "Take photographs with the connected D90 for one subject's session. The session is checked before the "
                 "shutter is\n"
                 "released. The camera's card keeps every photograph; nothing is ever deleted on it.",
                 "striae -C trial capture --session 3f0c2f6e-8f4f-4c1e-9d39-5d2f3f1f9a11 --as wound:W1 --n 3");
  auto options = std::make_shared<Options>();
  AddTagOptions(*command, options->tag);
  command->add_option("--n", options->shots, "How many photographs")->check(CLI::Range(1, 100))->capture_default_str();
  command->add_option("--port", options->port, "usb:BUS,DEVICE or ptpip:HOST:PORT:PORT; otherwise the D90 on USB")
      ->type_name("PORT");
  OnRun(command, context, [options](Context& run) { return Capture(run, *options); });
}

}  // namespace striae::app
