// `striae print board|label`: targets for the printer.
#include <fmt/format.h>

#include "app/io/files.h"
#include "app/names.h"
#include "app/study.h"
#include "report/print/targets.h"

namespace striae::app {
namespace {

struct Options {
  std::string range = "small";
  std::filesystem::path out;
  std::vector<std::string> sessions;
  double side_mm = 0;
  int copies = 1;
};

Status PrintBoard(Context& run, const Options& options) {
  const auto range = ParseRigRange(options.range);
  if (!range) return Fail(range.error(), "--range");
  const CharucoBoard board = BoardFor(*range);
  const auto paper = report::PaperFor(board);
  if (!paper) return Fail(paper.error());
  const auto pdf = report::PdfBoard(board, NewStamp().now);
  if (!pdf) return Fail(pdf.error());
  if (Status written = WriteFile(options.out, *pdf); !written) return written;
  run.Output({{"file", options.out.string()},
              {"paper", paper->name},
              {"columns", board.columns},
              {"rows", board.rows},
              {"square_mm", board.square_mm},
              {"marker_mm", board.marker_mm},
              {"dictionary", board.dictionary}},
             fmt::format("{}: {} landscape, {} x {} squares of {:g} mm; print at 100 % and measure the ruler",
                         options.out.string(), paper->name, board.columns, board.rows, board.square_mm));
  return {};
}

Status PrintLabels(Context& run, const Options& options) {
  const auto range = ParseRigRange(options.range);
  if (!range) return Fail(range.error(), "--range");
  const double side = options.side_mm > 0 ? options.side_mm : DefaultLabelSideMm(*range);
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto study = record->GetStudy();
  if (!study) return Fail(study.error());
  std::vector<report::LabelCard> cards;
  nlohmann::json list = nlohmann::json::array();
  for (const std::string& name : options.sessions) {
    const auto session = FindSession(*record, name);
    if (!session) return Fail(session.error());
    const auto subject = record->SubjectById(session->subject);
    if (!subject) return Fail(subject.error());
    const auto visit = record->VisitById(session->visit);
    if (!visit) return Fail(visit.error());
    const Label label = LabelFor(session->id, side);
    cards.insert(cards.end(), static_cast<std::size_t>(options.copies),
                 {label, {subject->pseudonym + "  " + visit->name, study->protocol}});
    list.push_back({{"session", session->id.ToString()},
                    {"code", label.session_code},
                    {"marker", label.marker_id},
                    {"side_mm", side},
                    {"dictionary", kLabelDictionary}});
  }
  const auto pdf = report::PdfLabels(cards, NewStamp().now);
  if (!pdf) return Fail(pdf.error());
  if (Status written = WriteFile(options.out, *pdf); !written) return written;
  run.Output({{"file", options.out.string()}, {"copies", options.copies}, {"labels", list}},
             fmt::format("{}: {} labels of {:g} mm; print at 100 % and measure the ruler", options.out.string(),
                         cards.size(), side));
  return {};
}

}  // namespace

void AddCommand_print(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "print", "Targets for the printer, at exact scale");
  auto board = std::make_shared<Options>();
  CLI::App* command = AddCommand(group, context, "board", "The board that a rig is calibrated with (PDF, A4 or A3)",
                                 "striae print board --range small --out board.pdf");
  command->add_option("--range", board->range, "small (1 m, A4) or large (2 m, A3)")->capture_default_str();
  command->add_option("--out", board->out, "PDF to write")->required();
  OnRun(command, context, [board](Context& run) { return PrintBoard(run, *board); });

  auto label = std::make_shared<Options>();
  command = AddCommand(group, context, "label", "Labels with a session's code, to be photographed with the subject",
                       "striae -C trial print label --session 3F2A-91BC --out label.pdf");
  command->add_option("--session", label->sessions, "Session, by id or code; several give a page of labels")
      ->required();
  command->add_option("--out", label->out, "PDF to write")->required();
  command->add_option("--side-mm", label->side_mm, "Side of the marker; by default 40 (small range) or 100 (large)");
  command->add_option("--range", label->range, "small (1 m) or large (2 m)")->capture_default_str();
  command->add_option("--copies", label->copies, "Labels of each session")->check(CLI::Range(1, 100));
  OnRun(command, context, [label](Context& run) { return PrintLabels(run, *label); });
}

}  // namespace striae::app
