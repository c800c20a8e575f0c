// The files of the record against its rows, one of 256 parts after the other.
#include <algorithm>

#include "store/detail/check.h"

namespace striae::store::detail {
namespace {

struct Known {
  Sha256 sha256;
  std::uint64_t size_bytes = 0;
};

}  // namespace

void CheckObjects(Database& database, const ObjectStore& objects, const Progress& progress, Findings& findings) {
  const auto all = static_cast<std::size_t>(database.Count("SELECT count(*) FROM object"));
  std::size_t done = 0;
  for (int part = 0; part < 256; ++part) {
    const std::string first = ToHex(std::array{static_cast<std::uint8_t>(part)});
    const auto known = database.Rows(
        "SELECT id, size_bytes FROM object WHERE id >= ?1 AND id < ?1 || 'g' ORDER BY id",
        [](const RowView& row) {
          return Known{row.Hash(0), static_cast<std::uint64_t>(row.Integer(1))};
        },
        first);
    for (const Known& object : known) {
      ++findings.report().objects;
      if (const Status sound = objects.Verify(object.sha256, object.size_bytes); !sound) {
        findings.Error("object " + object.sha256.ToString(), sound.error().message);
      }
      if (progress) progress(++done, all, "objects");
    }
    const auto listing = Unwrap(objects.ListPart(static_cast<std::uint8_t>(part)));
    for (const Sha256& sha256 : listing.objects) {
      const bool has_row = std::binary_search(known.begin(), known.end(), Known{sha256, 0},
                                              [](const Known& a, const Known& b) { return a.sha256 < b.sha256; });
      if (has_row) continue;
      findings.Warning("object " + sha256.ToString(),
                       "is in no row: left by a program that was stopped before it had finished; importing the file "
                       "again puts it right, 'striae check --repair' moves it to the quarantine");
    }
    for (const auto& path : listing.strangers) {
      findings.Warning(path.lexically_relative(objects.folder().parent_path()).string(),
                       "is not an object: an unfinished copy, or put there by hand; 'striae check --repair' moves it "
                       "to the quarantine");
    }
  }
}

}  // namespace striae::store::detail
