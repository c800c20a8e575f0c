"""The peers of jpeg_to_ply.py: a photograph's unwrapped phase with numpy, scipy and scikit-image.

numpy_phase.py IMAGE PERIOD_PX plain|tuned. Horizontal stripes, Hann window of relative half width 0.7, Herraez's
unwrapping in C within the mask. No order, no depth, no colour, no mesh, no file. `plain` is what one writes: double
precision, the photograph's own length. `tuned` knows the tricks: single precision, a padded length, all processors."""
import sys

import numpy as np
import scipy.fft
from PIL import Image
from skimage.restoration import unwrap_phase

from surfaces import plain_phase

image = np.asarray(Image.open(sys.argv[1]).convert("L"))
period = float(sys.argv[2])
if sys.argv[3] == "plain":
    phase, _ = plain_phase(image.astype(float), period)
else:
    image = image.astype(np.float32) / 255
    length = scipy.fft.next_fast_len(image.shape[0])
    spectrum = scipy.fft.fft(image - image.mean(axis=0), n=length, axis=0, workers=-1)
    distance = (scipy.fft.fftfreq(length) * period - 1) / 0.7
    window = np.where(np.abs(distance) < 1, 0.5 + 0.5 * np.cos(np.pi * distance), 0).astype(np.float32)
    signal = 2 * scipy.fft.ifft(spectrum * window[:, None], axis=0, workers=-1)[: image.shape[0]]
    amplitude = np.abs(signal)
    mask = amplitude < 0.25 * np.percentile(amplitude, 99)
    phase = unwrap_phase(np.ma.array(np.angle(signal), mask=mask))
print(int(phase.count()))
