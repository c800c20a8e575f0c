// striae_ptp_responder: the scripted camera as a program, for the demonstration. It listens on the loopback interface
// only and ends after --seconds or with the process that started it.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <thread>

#include <sys/prctl.h>
#include <unistd.h>

#include "tests/support/ptp_responder.h"

namespace {

using striae::testing::PtpBytes;

constexpr const char* kUsage =
    "usage: striae_ptp_responder --photo X.jpg [--photo Y.jpg ...] --port-file F [--seconds 60] [--fault NAME]\n"
    "                            [--serial 9000001] [--journal F]\n"
    "Presents a Nikon D90 over PTP/IP on a free port of 127.0.0.1. F gets the port's name for\n"
    "`striae capture --port`. The n-th trigger takes the n-th photograph.\n"
    "faults: out-of-focus store-full busy busy-twice no-event truncated corrupt stall silent shutter-by-hand\n";

struct Options {
  striae::testing::PtpCameraOptions camera;
  std::string port_file, journal;
  double seconds = 60;
};

bool Set(const std::string& name, const std::string& value, Options& options) {
  if (name == "--photo") {
    std::ifstream stream(value, std::ios::binary);
    if (!stream) {
      std::cerr << "cannot read " << value << '\n';
      return false;
    }
    options.camera.photographs.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    return true;
  }
  if (name == "--port-file") return !(options.port_file = value).empty();
  if (name == "--journal") return !(options.journal = value).empty();
  if (name == "--serial") return !(options.camera.serial = value).empty();
  if (name == "--seconds") return (options.seconds = std::strtod(value.c_str(), nullptr)) > 0;
  if (name == "--fault") return striae::testing::ParsePtpFault(value, options.camera.fault);
  return false;
}

bool Parse(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; i += 2) {
    if (i + 1 >= argc || !Set(argv[i], argv[i + 1], options)) return false;
  }
  return !options.port_file.empty() && !options.camera.photographs.empty();
}

/// Whole or absent, so that who waits for the file never reads half a name.
bool Write(const std::string& path, const std::string& text) {
  std::ofstream(path + ".part") << text << '\n';
  return std::rename((path + ".part").c_str(), path.c_str()) == 0;
}

}  // namespace

int main(int argc, char** argv) {
  const pid_t parent = ::getppid();
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) return 1;  // it ended before we asked
  Options options;
  if (!Parse(argc, argv, options)) {
    std::cerr << kUsage;
    return 2;
  }
  const striae::testing::PtpResponder responder(options.camera);
  if (!Write(options.port_file, responder.PortName())) {
    std::cerr << "cannot write " << options.port_file << '\n';
    return 1;
  }
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(options.seconds);
  while (std::chrono::steady_clock::now() < end && ::getppid() == parent) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (options.journal.empty()) continue;
    std::string text;
    for (const auto operation : responder.Journal()) {
      char code[8];
      std::snprintf(code, sizeof code, "%04X\n", operation);
      text += code;
    }
    Write(options.journal, text);
  }
  return 0;
}
