// Sending to a real storescp of DCMTK, and what is said when it is not there or does not want it.
#include "dicom/network.h"

#include <chrono>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/dicom/samples.h"
#include "tests/dicom/tools.h"
#include "tests/support/temp_dir.h"

namespace striae::dicom::testing {
namespace {

using ::testing::HasSubstr;

std::vector<std::filesystem::path> WriteAll(const striae::testing::TempDir& folder, const ThreeObjects& objects) {
  std::vector<std::filesystem::path> files;
  for (const Object* object : objects.All()) {
    files.push_back(folder / (std::string(ToString(object->reference.kind)) + ".dcm"));
    WriteBytes(files.back(), object->bytes);
  }
  return files;
}

/// From the data set on, two files of the same object are equal; the meta information names who wrote it.
std::string DataSetDump(const std::filesystem::path& path) {
  const std::string dump = RunTool({"dcmdump", "-q", "+L", "+R", "4096", path.string()}).output;
  return dump.substr(dump.find("# Dicom-Data-Set"));
}

Peer At(int port) {
  Peer peer;
  peer.host = "127.0.0.1";
  peer.port = port;
  peer.called_aet = "PACS";
  peer.timeout_s = 5;
  return peer;
}

TEST(Sending, AllThreeObjectsArriveAsTheyAre) {
  STRIAE_NEED_TOOL("storescp");
  const striae::testing::TempDir folder;
  const auto files = WriteAll(folder, MakeObjects());
  // +xa: storescp takes JPEG only when told to.
  const StoreScp pacs(folder / "received", {"+xa", "+uf"});
  ASSERT_TRUE(pacs.running());
  EXPECT_TRUE(Echo(At(pacs.port())));
  const auto report = Send(files, At(pacs.port()));
  ASSERT_TRUE(report) << report.error().Describe();
  EXPECT_TRUE(report->AllStored());
  ASSERT_EQ(report->outcomes.size(), 3U);
  std::set<std::string> received;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "received")) {
    received.insert(DataSetDump(entry.path()));
  }
  ASSERT_EQ(received.size(), 3U);
  for (const auto& file : files) EXPECT_TRUE(received.contains(DataSetDump(file))) << file;
}

TEST(Sending, OneKindThatIsNotWantedDoesNotStopTheOthers) {
  STRIAE_NEED_TOOL("storescp");
  const striae::testing::TempDir folder;
  const auto files = WriteAll(folder, MakeObjects());
  const StoreScp pacs(folder / "received", {});  // no JPEG
  ASSERT_TRUE(pacs.running());
  const auto report = Send(files, At(pacs.port()));
  ASSERT_TRUE(report) << report.error().Describe();
  EXPECT_FALSE(report->AllStored());
  EXPECT_FALSE(report->outcomes[0].stored);
  EXPECT_FALSE(report->outcomes[0].worth_retrying);
  EXPECT_THAT(report->outcomes[0].message, HasSubstr("does not accept this kind"));
  EXPECT_TRUE(report->outcomes[1].stored);
  EXPECT_TRUE(report->outcomes[2].stored);
}

TEST(Sending, APacsThatIsDownIsSaidAtOnce) {
  const striae::testing::TempDir folder;
  const auto files = WriteAll(folder, MakeObjects());
  const Peer nobody = At(FreePort());
  const auto start = std::chrono::steady_clock::now();
  for (const Error& error : {Send(files, nobody).error(), Echo(nobody).error()}) {
    EXPECT_EQ(error.code, ErrorCode::kNetworkFailed);
    EXPECT_THAT(error.message, HasSubstr("127.0.0.1:" + std::to_string(nobody.port)));
    EXPECT_THAT(error.message, HasSubstr("check that the PACS runs"));
  }
  // A closed port answers at once; twice the timeout would mean that it was waited out.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2 * nobody.timeout_s));
}

TEST(Sending, ARefusedAssociationNamesTheAeTitles) {
  STRIAE_NEED_TOOL("storescp");
  const striae::testing::TempDir folder;
  const auto files = WriteAll(folder, MakeObjects());
  const StoreScp pacs(folder / "received", {"--refuse"});
  ASSERT_TRUE(pacs.running());
  for (const Error& error : {Send(files, At(pacs.port())).error(), Echo(At(pacs.port())).error()}) {
    EXPECT_EQ(error.code, ErrorCode::kNetworkFailed);
    EXPECT_THAT(error.message, HasSubstr("called PACS, calling STRIAE"));
  }
}

TEST(Sending, APacsThatBreaksOffLeavesTheRestWorthRetrying) {
  STRIAE_NEED_TOOL("storescp");
  const striae::testing::TempDir folder;
  const auto files = WriteAll(folder, MakeObjects());
  const StoreScp pacs(folder / "received", {"+xa", "--abort-after"});
  ASSERT_TRUE(pacs.running());
  const auto report = Send(files, At(pacs.port()));
  ASSERT_TRUE(report) << report.error().Describe();
  EXPECT_FALSE(report->AllStored());
  EXPECT_TRUE(report->outcomes.back().worth_retrying);
  EXPECT_THAT(report->outcomes.back().message, HasSubstr("broke before it was answered"));
}

TEST(Sending, NothingIsSentWhenAFileIsNotDicom) {
  const striae::testing::TempDir folder;
  auto files = WriteAll(folder, MakeObjects());
  files.push_back(folder / "note.txt");
  WriteBytes(files.back(), {'h', 'e', 'l', 'l', 'o'});
  const auto report = Send(files, At(FreePort()));
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadFile);
  EXPECT_THAT(report.error().message, HasSubstr("note.txt"));
}

TEST(Sending, ImpossibleAddressesAreUsageErrors) {
  for (const auto& spoil : std::vector<void (*)(Peer&)>{
           [](Peer& p) { p.host.clear(); }, [](Peer& p) { p.port = 0; }, [](Peer& p) { p.port = 65536; },
           [](Peer& p) { p.called_aet = "SEVENTEEN_LETTERS"; }, [](Peer& p) { p.calling_aet = ""; },
           [](Peer& p) { p.timeout_s = 0; }}) {
    Peer peer = At(4242);
    spoil(peer);
    EXPECT_EQ(Echo(peer).error().code, ErrorCode::kUsage);
  }
  EXPECT_EQ(Send({}, At(4242)).error().code, ErrorCode::kUsage);
}

}  // namespace
}  // namespace striae::dicom::testing
