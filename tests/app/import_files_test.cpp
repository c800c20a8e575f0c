// Photographs from files and cards, as a coordinator imports them with the program.
#include <map>

#include "tests/app/import_study.h"

namespace striae {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Ran;

class ImportFiles : public testing::ProgramStudy {};

TEST_F(ImportFiles, ASidecarSaysWhoseItIsAndThePhotographStaysAsItWas) {
  const std::string photo = WritePhoto("card/DSC_0001.JPG");
  const auto before = testing::ReadBytes(photo);
  const json ran = Do(
      {"import", "--session", session_, photo, "--as", "wound:W1", "--site", "calf", "--laterality", "L", "--sidecar"});
  EXPECT_EQ(testing::ReadBytes(photo), before);
  EXPECT_EQ(ran.at("files").at(0).at("sidecar"), photo + ".xmp");
  const std::string xmp = testing::ReadText(photo + ".xmp");
  for (const std::string& word :
       {std::string("striae:Subject=\"S001\""), "striae:Session=\"" + session_ + "\"",
        std::string("striae:Visit=\"V1\""), "striae:Capture=\"" + ran["files"][0]["capture"].get<std::string>() + "\"",
        "striae:SHA256=\"" + ran["files"][0]["sha256"].get<std::string>() + "\"",
        std::string("striae:Role=\"wound:W1\""), std::string("striae:BodySite=\"calf\"")}) {
    EXPECT_THAT(xmp, HasSubstr(word));
  }
  // Again: the same bytes, and nothing is imported.
  EXPECT_EQ(Do({"import", "--session", session_, photo, "--sidecar"}).at("already_there"), 1);
  EXPECT_EQ(testing::ReadText(photo + ".xmp"), xmp);
}

TEST_F(ImportFiles, AnotherProgramsSidecarIsLeftAsItIs) {
  const std::string photo = WritePhoto("DSC_0001.JPG");
  const std::string theirs = Write("DSC_0001.JPG.xmp", "<x:xmpmeta xmlns:x='adobe:ns:meta/'/>");
  const Ran ran = Run({"import", "--session", session_, photo, "--sidecar"});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("another program's"));
  EXPECT_EQ(ran.Json().at("added"), 1) << "the photograph is in all the same";
  EXPECT_EQ(testing::ReadText(theirs), "<x:xmpmeta xmlns:x='adobe:ns:meta/'/>");
}

TEST_F(ImportFiles, AWholeCardWithRawFilesGoesInOnce) {
  testing::PhotoOptions options;
  testing::WriteBytes(dir_ / "card/DCIM/100NCD90/DSC_0001.NEF", testing::MakeNef(options));
  WritePhoto("card/DCIM/100NCD90/DSC_0001.JPG");
  WritePhoto("card/DCIM/101NCD90/DSC_0001.JPG");  // the camera's names repeat
  const json first = Do({"import", "--session", session_, Path("card")});
  EXPECT_EQ(first.at("added"), 3);
  const json& raw = first.at("files").at(1);
  EXPECT_EQ(raw.at("media_type"), "image/x-nikon-nef");
  EXPECT_TRUE(raw.contains("verdict"));
  EXPECT_FALSE(raw.at("preflight").empty());
  const json rows = Do({"check"}).at("audit_rows");
  const json again = Do({"import", "--session", session_, Path("card")});
  EXPECT_EQ(again.at("added"), 0);
  EXPECT_EQ(again.at("already_there"), 3);
  EXPECT_EQ(Do({"check"}).at("audit_rows"), rows) << "a second import changes nothing at all";
  EXPECT_EQ(Do({"show", session_}).at("captures").size(), 3U);
}

TEST_F(ImportFiles, WhatIsBrokenIsInQuarantineAndStatusNamesItUntilItIsSettled) {
  auto bytes = Photo("whole");
  const auto whole = bytes;
  bytes.resize(bytes.size() / 2);
  testing::WriteBytes(dir_ / "DSC_0007.JPG", bytes);
  EXPECT_EQ(Run({"import", "--session", session_, Path("DSC_0007.JPG")}).exit_code, 1);
  const json quarantine = Do({"status"}).at("quarantine");
  ASSERT_EQ(quarantine.size(), 1U);
  EXPECT_THAT(quarantine[0].at("file").get<std::string>(), HasSubstr("DSC_0007.JPG"));
  EXPECT_THAT(quarantine[0].at("message").get<std::string>(), HasSubstr("truncated"));
  EXPECT_THAT(testing::Striae({"-C", study_, "status"}).out, HasSubstr("DSC_0007.JPG"));
  EXPECT_EQ(Do({"check"}).at("findings"), json::array()) << "it is where it belongs";
}

TEST_F(ImportFiles, TheSamePhotographUnderTwoSubjectsIsRefusedAndTheFirstPlaceNamed) {
  Do({"subject", "add", "S002"});
  Do({"consent", "S002", "--given", "2026-05-01"});
  const std::string other = Do({"session", "open", "--subject", "S002", "--visit", "V1"}).at("id");
  const std::string photo = WritePhoto("DSC_0001.JPG");
  Do({"import", "--session", session_, photo});
  const Ran ran = Run({"import", "--session", other, photo});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_THAT(ran.err, HasSubstr("S001"));
  EXPECT_THAT(ran.err, HasSubstr(session_));
}

TEST_F(ImportFiles, ASessionIsNamedByItsIdItsBeginningOrItsLabelsCode) {
  const std::string begin = session_.substr(0, 8);
  const std::string code = begin.substr(0, 4) + "-" + begin.substr(4);
  int number = 0;
  for (const std::string& name : {session_, begin, code}) {
    const std::string photo = WritePhoto("DSC_" + std::to_string(++number) + ".JPG");
    EXPECT_EQ(Do({"import", "--session", name, photo}).at("session"), session_) << name;
  }
  EXPECT_EQ(Do({"show", session_}).at("captures").size(), 3U);
  EXPECT_EQ(Do({"session", "close", code}).at("id"), session_);
  const Ran none = Run({"import", "--session", begin.substr(0, 7), WritePhoto("DSC_9.JPG")});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.err, HasSubstr("striae session list"));
}

TEST_F(ImportFiles, ReconcileHoldsACardAgainstTheRecord) {
  WritePhoto("card/DCIM/DSC_0001.JPG");
  WritePhoto("card/DCIM/DSC_0002.JPG");
  Do({"import", "--session", session_, Path("card")});
  WritePhoto("card/DCIM/DSC_0003.JPG");
  auto cut = Photo("cut");
  cut.resize(cut.size() - 40);
  testing::WriteBytes(dir_ / "card/DCIM/DSC_0004.JPG", cut);
  fs::remove(Path("card/DCIM/DSC_0002.JPG"));
  fs::rename(Path("card/DCIM/DSC_0001.JPG"), Path("card/DCIM/RENAMED.JPG"));
  const json rows = Do({"check"}).at("audit_rows");
  const json said = Do({"reconcile", Path("card")});
  EXPECT_EQ(said.at("imported"), 1) << "by content, not by name";
  EXPECT_EQ(said.at("not_imported"), 1);
  EXPECT_EQ(said.at("broken"), 1);
  ASSERT_EQ(said.at("missing").size(), 1U);
  EXPECT_EQ(said["missing"][0].at("file_name"), "DSC_0002.JPG");
  EXPECT_EQ(said["missing"][0].at("subject"), "S001");
  EXPECT_EQ(Do({"check"}).at("audit_rows"), rows) << "nothing was changed";
  EXPECT_EQ(Run({"reconcile", Path("absent")}).exit_code, 1);
}

/// The other reader's dump beside the photograph: "[Directory - 0xTAG] Name = value".
std::map<std::string, std::string> Dump(const fs::path& file) {
  std::map<std::string, std::string> values;
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    const auto bracket = line.find(']'), equals = line.find(" = ");
    if (line.empty() || line[0] != '[' || bracket == std::string::npos || equals == std::string::npos) continue;
    std::string value = line.substr(equals + 3);
    value.erase(value.find_last_not_of(" \r") + 1);
    values[line.substr(1, bracket - 1)] = value;
  }
  return values;
}

TEST_F(ImportFiles, TheRealD90PhotographIsInTheRecordWithEveryFieldRight) {
  STRIAE_NEED_DATA("nikon_d90/Nikon D90.jpg");
  const auto file = testing::TestData("nikon_d90/Nikon D90.jpg");
  const json taken = Do({"import", "--session", session_, file.string()}).at("files").at(0);
  EXPECT_EQ(taken.at("verdict"), "failed") << "a 24 mm lens and no flash";
  std::map<std::string, std::string> states;
  for (const json& item : taken.at("preflight")) states[item.at("name")] = item.at("state");
  EXPECT_EQ(states["flash"], "failed");
  EXPECT_EQ(states["focal length"], "failed");
  EXPECT_EQ(states["camera"], "ok");
  EXPECT_EQ(states["ISO"], "ok");
  const json shown = Do({"show", taken.at("capture").get<std::string>()});
  const json& in = shown.at("photograph");
  auto out = Dump(testing::TestData("nikon_d90/Nikon D90.jpg.metadata-extractor.txt"));
  const std::map<std::string, std::string> same = {{"make", "Exif IFD0 - 0x010f"},
                                                   {"model", "Exif IFD0 - 0x0110"},
                                                   {"body_serial", "Nikon Makernote - 0x001d"},
                                                   {"quality", "Nikon Makernote - 0x0004"},
                                                   {"white_balance", "Nikon Makernote - 0x0005"},
                                                   {"focus_mode", "Nikon Makernote - 0x0007"}};
  for (const auto& [ours, theirs] : same) EXPECT_EQ(in.value(ours, ""), out[theirs]) << ours;
  EXPECT_EQ(std::to_string(in.value("iso", 0)), out["Exif SubIFD - 0x8827"]);
  EXPECT_EQ(std::to_string(in.value("shutter_count", 0)), out["Nikon Makernote - 0x00a7"]);
  EXPECT_EQ(std::to_string(in.value("width_px", 0)) + " pixels", out["JPEG - 0x0003"]);
  EXPECT_EQ(std::to_string(in.value("height_px", 0)) + " pixels", out["JPEG - 0x0001"]);
  EXPECT_EQ(in.value("taken_at_camera_clock", ""), out["Exif SubIFD - 0x9003"] + "." + out["Exif SubIFD - 0x9291"]);
  // What the other reader words for a person.
  EXPECT_EQ(out["Exif SubIFD - 0x829a"], "0.1 sec");
  EXPECT_DOUBLE_EQ(in.value("exposure_s", 0.0), 0.1);
  EXPECT_EQ(out["Exif SubIFD - 0x829d"], "f/3.2");
  EXPECT_DOUBLE_EQ(in.value("f_number", 0.0), 3.2);
  EXPECT_EQ(out["Exif SubIFD - 0x920a"], "24 mm");
  EXPECT_DOUBLE_EQ(in.value("focal_length_mm", 0.0), 24.0);
  EXPECT_EQ(out["Exif SubIFD - 0x9209"], "Flash did not fire");
  EXPECT_EQ(in.value("flash_fired", true), false);
  EXPECT_EQ(out["Exif IFD0 - 0x0112"], "Top, left side (Horizontal / normal)");
  EXPECT_EQ(in.value("orientation", 0), 1);
  EXPECT_THAT(in.value("lens", ""), HasSubstr(out["Nikon Makernote - 0x0084"]));
}

}  // namespace
}  // namespace striae
