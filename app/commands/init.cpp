// `striae init`: a new study.
#include "app/local_time.h"
#include "app/study.h"
#include "store/json.h"

namespace striae::app {
namespace {

struct Options {
  std::filesystem::path folder;
  Study study;
  Site site;
};

}  // namespace

void AddCommand_init(CLI::App& root, Context& context) {
  CLI::App* command = AddCommand(root, context, "init", "Make a new study in an empty or new folder",
                                 "striae init trial --protocol WND-01 --title \"Healing of leg ulcers\" --sponsor "
                                 "\"Example Institute\" --site LJ --time-zone Europe/Ljubljana");
  auto options = std::make_shared<Options>();
  command->add_option("DIR", options->folder, "The study's folder")->required();
  command->add_option("--protocol", options->study.protocol, "The sponsor's protocol number")->required();
  command->add_option("--title", options->study.title, "Title of the study")->required();
  command->add_option("--sponsor", options->study.sponsor, "Who is responsible for the study")->required();
  command->add_option("--coordinating-centre", options->study.coordinating_centre, "Coordinating centre");
  command->add_option("--site", options->site.code, "Short code of the site that this copy belongs to")->required();
  command->add_option("--site-name", options->site.name, "Name of the site");
  command->add_option("--time-zone", options->site.time_zone,
                      "IANA name of the site's time zone (default: this machine's)");
  command->add_option("--subject-pattern", options->study.subject_pattern,
                      "Pattern of pseudonyms: # a digit, ? a capital letter, C at its end a check digit (S###C)");
  command->add_option("--check-digit", options->study.check_digit,
                      "Method of the check digit: iso7064 (default), luhn or verhoeff");
  OnRun(command, context, [options](Context& run) -> Status {
    const store::Stamp stamp = NewStamp();
    Study study = options->study;
    study.id = NewId<StudyId>();
    if (study.check_digit.empty() && study.subject_pattern.ends_with('C')) study.check_digit = "iso7064";
    Site site = options->site;
    site.id = NewId<SiteId>();
    if (site.time_zone.empty()) site.time_zone = stamp.zone;
    if (const Status known = CheckZone(site.time_zone); !known) return known;
    const auto record = store::Record::Create(options->folder, study, site, NewUuid(), stamp);
    if (!record) return Fail(record.error(), "making the study");
    run.Output({{"id", study.id.ToString()}, {"study", store::ToJson(study)}, {"site", store::ToJson(site)}},
               "study " + study.protocol + " in " + options->folder.string() + "; next: striae -C " +
                   options->folder.string() + " subject add S001");
    return {};
  });
}

}  // namespace striae::app
