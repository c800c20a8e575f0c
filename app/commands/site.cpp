// `striae site add|list`: the study's sites.
#include "app/listing.h"
#include "app/local_time.h"
#include "app/study.h"
#include "store/json.h"
#include "store/sites.h"

namespace striae::app {
namespace {

Status Add(Context& run, Site site) {
  if (const Status known = CheckZone(site.time_zone); !known) return known;
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  site.id = NewId<SiteId>();
  if (const Status added = store::AddSite(*record, site, NewStamp()); !added) {
    return Fail(added.error(), "adding a site");
  }
  run.Output(store::ToJson(site), "site " + site.code + "; next: striae subject add PSEUDONYM --site " + site.code);
  return {};
}

Status List(Context& run) {
  auto record = OpenStudy(run);
  if (!record) return Fail(record.error());
  const auto sites = record->Sites();
  if (!sites) return Fail(sites.error());
  Listing listing(run, "sites", "no sites");
  for (const Site& site : *sites) {
    listing.Add(listing.json() ? store::ToJson(site).dump() : site.code + "  " + site.name + "  " + site.time_zone);
  }
  return listing.Print();
}

}  // namespace

void AddCommand_site(CLI::App& root, Context& context) {
  CLI::App& group = Group(root, "site", "Sites of the study");
  auto site = std::make_shared<Site>();
  CLI::App* add = AddCommand(group, context, "add", "Add a site beside the one that the study was made at",
                             "striae -C trial site add MB --name \"Example Hospital\" --time-zone Europe/Ljubljana");
  add->add_option("CODE", site->code, "Short code of the site")->required();
  add->add_option("--name", site->name, "Name of the site");
  add->add_option("--time-zone", site->time_zone, "IANA name of the site's time zone")->required();
  OnRun(add, context, [site](Context& run) { return Add(run, *site); });
  OnRun(AddCommand(group, context, "list", "List the sites", "striae -C trial site list"), context, List);
}

}  // namespace striae::app
