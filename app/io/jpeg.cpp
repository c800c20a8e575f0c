#include "app/io/jpeg.h"

#include <atomic>
#include <csetjmp>
#include <cstdio>
#include <string>
#include <thread>

#include <jpeglib.h>

#include "app/io/luminance.h"

namespace striae::app {
namespace {

static_assert(sizeof(Rgb8) == 3, "rows are decoded straight into the image");

/// A file this much shorter than its pixels (bytes per pixel) is cut: even a uniform picture takes three times as much.
constexpr std::size_t kFewestPixelsPerByte = 500;

tl::unexpected<Error> Bad(const std::string& what) {
  return Fail(ErrorCode::kBadImage,
              "the JPEG is truncated or damaged (" + what + "); take the file from the camera's card again");
}

struct JpegErrors {
  jpeg_error_mgr base;
  std::jmp_buf back;
  char text[JMSG_LENGTH_MAX] = "";
};

[[noreturn]] void Stop(j_common_ptr info) {
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  errors->base.format_message(info, errors->text);
  std::longjmp(errors->back, 1);
}

/// libjpeg goes on after "premature end of file" with grey: for a measurement every warning is an error.
void StopOnWarning(j_common_ptr info, int level) {
  if (level < 0) Stop(info);
}

/// How many rows are decoded, for the thread that follows; kFailed when no more will come.
using Progress = std::atomic<int>;
constexpr int kFailed = -1;

/// Reads rows into `rgb`. False with errors.text set on failure. Only trivially destructible locals here: longjmp skips
/// destructors.
bool DecodeRows(jpeg_decompress_struct& info, JpegErrors& errors, ImageRgb& rgb, Progress& rows) {
  constexpr int kRowsAtOnce = 64;
  if (setjmp(errors.back) != 0) return false;
  jpeg_start_decompress(&info);
  while (info.output_scanline < info.output_height) {
    auto* row = reinterpret_cast<JSAMPROW>(rgb.Row(static_cast<int>(info.output_scanline)));
    jpeg_read_scanlines(&info, &row, 1);
    if (const int done = static_cast<int>(info.output_scanline); done % kRowsAtOnce == 0) {
      rows.store(done, std::memory_order_release);
      rows.notify_one();
    }
  }
  jpeg_finish_decompress(&info);
  return true;
}

bool ReadHeader(jpeg_decompress_struct& info, JpegErrors& errors, std::span<const std::uint8_t> bytes) {
  if (setjmp(errors.back) != 0) return false;
  jpeg_mem_src(&info, bytes.data(), bytes.size());
  jpeg_read_header(&info, TRUE);
  info.out_color_space = JCS_RGB;
  return true;
}

/// Turns rows into luminance as they come, on a thread of its own: decoding itself cannot be shared between threads.
void FollowWithLuminance(const ImageRgb& rgb, const Progress& rows, ImageF& luminance) {
  luminance = ImageF::Unset(rgb.width(), rgb.height());
  constexpr float kScale = 1.0F / 255;
  int done = 0;
  while (done < rgb.height()) {
    rows.wait(done, std::memory_order_acquire);
    const int ready = rows.load(std::memory_order_acquire);
    if (ready == kFailed) return;
    for (; done < ready; ++done) {
      const Rgb8* in = rgb.Row(done);
      float* out = luminance.Row(done);
      for (int x = 0; x < rgb.width(); ++x) out[x] = kScale * Luminance(in[x].r, in[x].g, in[x].b);
    }
  }
}

}  // namespace

Result<Photograph> DecodeJpeg(std::span<const std::uint8_t> bytes) {
  jpeg_decompress_struct info{};
  JpegErrors errors;
  info.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = Stop;
  errors.base.emit_message = StopOnWarning;
  jpeg_create_decompress(&info);
  Photograph photograph;
  photograph.saturation_level = kSaturated8;
  bool good = ReadHeader(info, errors, bytes);
  if (good && std::size_t{info.image_width} * info.image_height / kFewestPixelsPerByte > bytes.size()) {
    jpeg_destroy_decompress(&info);
    return Bad("far too few bytes for its size");
  }
  if (good) {
    photograph.colour = ImageRgb::Unset(static_cast<int>(info.image_width), static_cast<int>(info.image_height));
    Progress rows{0};
    std::thread follower([&] { FollowWithLuminance(photograph.colour, rows, photograph.luminance); });
    good = DecodeRows(info, errors, photograph.colour, rows);
    rows.store(good ? photograph.colour.height() : kFailed, std::memory_order_release);
    rows.notify_one();
    follower.join();
  }
  jpeg_destroy_decompress(&info);
  if (!good) return Bad(errors.text);
  return photograph;
}

}  // namespace striae::app
