// `striae` itself. The whole program needs two hundred libraries, and loading them takes longer than the phase of a
// twelve-megapixel photograph. So the one command that is run most, a JPEG to a PLY, is served here, with the five that
// it needs; the record's commands go to a program without those of the reconstruction, and anything else, any other
// option and any mistake on the command line goes to the whole program beside it.
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <unistd.h>

#include "app/exit.h"
#include "app/io/files.h"
#include "app/io/image_header.h"
#include "app/io/jpeg.h"
#include "app/io/ply_file.h"
#include "app/reconstructing.h"

namespace {

namespace fs = std::filesystem;
using namespace striae;
using namespace striae::app;

struct Request {
  fs::path image, calibration, out;
  std::optional<double> distance_mm;
  bool json = false, faces = true;
};

std::optional<double> Positive(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value > 0)) return std::nullopt;
  return value;
}

/// nullopt for all that is not the plain command.
std::optional<Request> Parse(const std::vector<std::string_view>& words) {
  if (words.empty() || words[0] != "reconstruct") return std::nullopt;
  Request request;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string_view word = words[i];
    const auto value = i + 1 < words.size() ? words[i + 1] : std::string_view();
    if (word == "--json") {
      request.json = true;
    } else if (word == "--no-faces") {
      request.faces = false;
    } else if (word == "--distance-mm") {
      request.distance_mm = Positive(value);
      if (!request.distance_mm) return std::nullopt;
      ++i;
    } else if ((word == "--calibration" || word == "--out") && !value.starts_with('-') && !value.empty()) {
      fs::path& path = word == "--out" ? request.out : request.calibration;
      if (!path.empty()) return std::nullopt;
      path = value;
      ++i;
    } else if (!word.starts_with('-') && !word.empty() && request.image.empty()) {
      request.image = word;
    } else {
      return std::nullopt;
    }
  }
  const bool whole = !request.image.empty() && !request.calibration.empty() && request.out.extension() == ".ply";
  return whole ? std::optional(request) : std::nullopt;
}

struct Decoded {
  Result<Photograph> photograph;
  Sha256 sha256;
};

/// Decoding keeps one thread busy; another one has the file's hash meanwhile.
Decoded Decode(const std::vector<std::uint8_t>& bytes) {
  Sha256 sha256;
  std::thread meanwhile([&] { sha256 = HashOf(bytes); });
  auto photograph = DecodeJpeg(bytes);
  meanwhile.join();
  return {std::move(photograph), sha256};
}

Status Serve(const Request& request, const std::vector<std::uint8_t>& bytes, double start) {
  if (Status writable = CheckWritable(request.out); !writable) return writable;
  Sha256 calibration_sha256;
  const auto calibration = ReadCalibration(request.calibration, calibration_sha256);
  if (!calibration) return Fail(calibration.error());
  auto [photograph, photograph_sha256] = Decode(bytes);
  if (!photograph) return Fail(photograph.error(), request.image.string());
  const double decoded = Now();
  reconstruct::ReconstructOptions settings;
  settings.distance_mm = request.distance_mm;
  settings.faces = request.faces;
  auto result = reconstruct::ReconstructOnSensor(*std::move(photograph), *calibration, settings, Now);
  if (!result) return Fail(result.error(), request.image.string());
  SayWhatItIsMadeOf(photograph_sha256, calibration_sha256, result->surface.comments);
  const double reconstructed = Now();
  if (Status written = WritePly([&](const PieceSink& sink) { return result->surface.EncodePly(sink); }, request.out,
                                result->surface.FileBytes());
      !written)
    return written;
  result->seconds.insert(result->seconds.begin(), {"decode", decoded - start});
  result->seconds.emplace_back("write", Now() - reconstructed);
  result->seconds.emplace_back("total", Now() - start);
  Context context;
  context.json = request.json;
  Announce(context, *result, {result->surface.points(), result->surface.faces()}, {{"files", {request.out.string()}}},
           request.out);
  return {};
}

/// The command's name, after the options that all commands share.
std::string_view CommandOf(const std::vector<std::string_view>& words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!words[i].starts_with('-')) return words[i];
    if (words[i] == "-C" || words[i] == "--user") ++i;
  }
  return {};
}

bool IsOfTheRecord(std::string_view command) {
  return !command.empty() &&
         std::string_view(STRIAE_RECORD_COMMANDS).find(" " + std::string(command) + " ") != std::string_view::npos;
}

/// Becomes the program of the record's commands or the whole one; returns only when that is not there.
int Hand(const std::vector<std::string_view>& words, char** argv) {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  if (IsOfTheRecord(CommandOf(words))) execv((folder / "striae-record").c_str(), argv);
  const fs::path whole = folder / "striae-whole";
  execv(whole.c_str(), argv);
  std::cerr << "striae: " << whole.string() << " cannot be started (" << std::strerror(errno)
            << "); install Striae again, all its programs in one folder\n";
  return kExitFailed;
}

int Run(int argc, char** argv) {
  const std::vector<std::string_view> words(argv + (argc > 0 ? 1 : 0), argv + argc);
  const auto request = Parse(words);
  if (!request) return Hand(words, argv);
  const double start = Now();
  const auto bytes = ReadFile(request->image);
  if (!bytes) return Hand(words, argv);
  const auto header = ReadImageHeader(*bytes);
  if (!header || header->kind != ImageKind::kJpeg) return Hand(words, argv);
  const Status served = Serve(*request, *bytes, start);
  return served ? kExitDone : ReportError(served.error());
}

}  // namespace

int main(int argc, char** argv) {
  return Guarded([&] { return Run(argc, argv); });
}
