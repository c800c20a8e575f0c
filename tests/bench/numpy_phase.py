"""The peer of jpeg_to_ply.py: a photograph's unwrapped phase with numpy, scipy and scikit-image, as one would write it.

numpy_phase.py IMAGE PERIOD_PX. Horizontal stripes, Hann window of relative half width 0.7, Herraez's unwrapping in C
within the mask. No order, no depth, no colour, no mesh, no file."""
import sys

import numpy as np
import scipy.fft
from PIL import Image
from skimage.restoration import unwrap_phase

image = np.asarray(Image.open(sys.argv[1]).convert("L"), dtype=np.float32) / 255
carrier = 1 / float(sys.argv[2])
length = scipy.fft.next_fast_len(image.shape[0])
spectrum = scipy.fft.fft(image - image.mean(axis=0), n=length, axis=0, workers=-1)
distance = (np.fft.fftfreq(length) - carrier) / (0.7 * carrier)
window = np.where(np.abs(distance) < 1, 0.5 + 0.5 * np.cos(np.pi * distance), 0).astype(np.float32)
signal = 2 * scipy.fft.ifft(spectrum * window[:, None], axis=0, workers=-1)[: image.shape[0]]
amplitude = np.abs(signal)
mask = amplitude < 0.25 * np.percentile(amplitude, 99)
phase = unwrap_phase(np.ma.array(np.angle(signal), mask=mask))
print(int(phase.count()))
