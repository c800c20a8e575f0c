#include "app/io/raw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <libraw/libraw.h>

#include "app/io/image_header.h"
#include "app/io/jpeg.h"
#include "app/io/luminance.h"
#include "core/srgb.h"

namespace striae::app {
namespace {

tl::unexpected<Error> Bad(const std::string& what) {
  return Fail(ErrorCode::kBadImage, what + "; take the file from the camera's card again");
}

/// IEC 61966-2-1 for every 16-bit value of linear light.
class SrgbTable {
 public:
  SrgbTable() : codes_(65536) {
    for (std::size_t i = 0; i < codes_.size(); ++i) {
      codes_[i] = static_cast<std::uint8_t>(std::lround(255 * SrgbFromLight(static_cast<double>(i) / 65535)));
    }
  }
  std::uint8_t operator()(float linear) const {
    return codes_[static_cast<std::size_t>(std::clamp(linear, 0.0F, 65535.0F))];
  }

 private:
  std::vector<std::uint8_t> codes_;
};

/// The sensor's picture in the camera's own colours, 16-bit linear, white balanced; kBadImage where LibRaw finds fault.
Status Develop(LibRaw& raw, std::span<const std::uint8_t> bytes) {
  bool damaged = false;
  raw.set_dataerror_handler([](void* flag, const char*, int) { *static_cast<bool*>(flag) = true; }, &damaged);
  auto& parameters = raw.imgdata.params;
  parameters.use_camera_wb = 1;
  parameters.output_color = 0;
  parameters.output_bps = 16;
  parameters.gamm[0] = parameters.gamm[1] = 1;
  parameters.no_auto_bright = 1;
  parameters.user_flip = 0;
  parameters.user_qual = 0;           // bilinear
  parameters.highlight = 0;           // full is full: white stays white
  parameters.adjust_maximum_thr = 0;  // and not the brightest value of this one photograph
  parameters.max_raw_memory_mb = 1024;
  const auto check = [&](int code) -> Status {
    if (code != LIBRAW_SUCCESS) return Bad(std::string("the raw file cannot be read (") + libraw_strerror(code) + ")");
    if (damaged) return Bad("the raw file is truncated or damaged");
    return {};
  };
  // LibRaw reads through this pointer and writes nothing.
  if (Status s = check(raw.open_buffer(const_cast<std::uint8_t*>(bytes.data()), bytes.size())); !s) return s;
  const auto& sizes = raw.imgdata.sizes;
  if (std::int64_t{sizes.raw_width} * sizes.raw_height > kMostPixels) {
    return Bad("the raw file has more than 100 megapixels");
  }
  if (raw.imgdata.idata.colors != 3 || raw.imgdata.idata.filters == 0) {
    return Bad("only raw files of sensors with a red, green and blue filter array are read");
  }
  if (Status s = check(raw.unpack()); !s) return s;
  return check(raw.dcraw_process());
}

struct Cut {
  int col = 0, row = 0, width = 0, height = 0;
};

/// sRGB-encoded luminance, for the comparison with the embedded JPEG.
ImageF EncodedLuminance(const Photograph& photograph) {
  ImageF out(photograph.colour.width(), photograph.colour.height());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Rgb8 c = photograph.colour.pixels()[i];
    out.pixels()[i] = Luminance(c.r, c.g, c.b) / 255;
  }
  return out;
}

/// The part that the camera's JPEG shows.
Cut CutOf(LibRaw& raw, const Photograph& whole) {
  const int width = whole.luminance.width(), height = whole.luminance.height();
  if (raw.unpack_thumb() == LIBRAW_SUCCESS && raw.imgdata.thumbnail.tformat == LIBRAW_THUMBNAIL_JPEG) {
    const auto* data = reinterpret_cast<const std::uint8_t*>(raw.imgdata.thumbnail.thumb);
    const std::span<const std::uint8_t> bytes(data, raw.imgdata.thumbnail.tlength);
    const auto header = ReadImageHeader(bytes);
    Offset at;
    if (header && header->kind == ImageKind::kJpeg && header->width <= width && header->height <= height) {
      const auto embedded = DecodeJpeg(bytes);
      if (embedded && FindPart(EncodedLuminance(whole), embedded->luminance, at)) {
        return {at.col, at.row, embedded->luminance.width(), embedded->luminance.height()};
      }
    }
  }
  constexpr int kD90Width = 4288, kD90Height = 2848;
  const std::string_view model = raw.imgdata.idata.model;
  if (model.find("D90") != std::string_view::npos && width >= kD90Width && height >= kD90Height) {
    return {(width - kD90Width) / 2, (height - kD90Height) / 2, kD90Width, kD90Height};
  }
  return {0, 0, width, height};
}

Photograph FromSensor(const LibRaw& raw) {
  static const SrgbTable srgb;
  constexpr float kFull = 65535, kScale = 1 / kFull;
  constexpr int kNearlyFull = 65400;  // the white level's own noise
  const int width = raw.imgdata.sizes.iwidth, height = raw.imgdata.sizes.iheight;
  Photograph out{ImageF::Unset(width, height), ImageRgb::Unset(width, height), 1.0F, true};
  const auto& to_srgb = raw.imgdata.color.rgb_cam;
  for (std::size_t i = 0; i < out.luminance.size(); ++i) {
    const std::uint16_t* p = raw.imgdata.image[i];
    const bool full = p[0] >= kNearlyFull || p[1] >= kNearlyFull || p[2] >= kNearlyFull;
    out.luminance.pixels()[i] = full ? 1.0F : kScale * Luminance(p[0], p[1], p[2]);
    const auto channel = [&](int c) {
      return srgb(to_srgb[c][0] * static_cast<float>(p[0]) + to_srgb[c][1] * static_cast<float>(p[1]) +
                  to_srgb[c][2] * static_cast<float>(p[2]));
    };
    out.colour.pixels()[i] = {channel(0), channel(1), channel(2)};
  }
  return out;
}

template <typename T>
void Crop(const Cut& cut, Image<T>& image) {
  if (cut.width == image.width() && cut.height == image.height()) return;
  Image<T> out(cut.width, cut.height);
  for (int row = 0; row < cut.height; ++row) {
    std::copy_n(image.Row(cut.row + row) + cut.col, cut.width, out.Row(row));
  }
  image = std::move(out);
}

}  // namespace

Result<Photograph> DecodeRaw(std::span<const std::uint8_t> bytes) {
  try {
    const auto raw = std::make_unique<LibRaw>(0U);  // too large for the stack
    if (Status developed = Develop(*raw, bytes); !developed) return Fail(developed.error());
    Photograph photograph = FromSensor(*raw);
    const Cut cut = CutOf(*raw, photograph);
    Crop(cut, photograph.luminance);
    Crop(cut, photograph.colour);
    return photograph;
  } catch (const std::exception& e) {
    return Bad(std::string("the raw file cannot be read (") + e.what() + ")");
  }
}

}  // namespace striae::app
