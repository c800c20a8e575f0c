"""What the benchmarks share: running a program with its time and memory, reading surfaces, the plain phase of a peer."""
import os
import subprocess
import sys
import time

import numpy as np

SKIPPED = 77


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def run(command, environment=None):
    """Wall seconds, CPU seconds, peak MiB, exit code and standard output of a program."""
    start = time.perf_counter()
    process = subprocess.Popen([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                               env={**os.environ, **(environment or {})})
    out = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    wall = time.perf_counter() - start
    return wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, process.returncode, out


def must_run(command, environment=None):
    result = run(command, environment)
    if result[3] != 0:
        sys.exit(f"{' '.join(str(part) for part in command)}: exit code {result[3]}")
    return result


def read_vertices(path):
    """The header's lines (without end_header) and the vertex element, a structured array, of a binary PLY."""
    kinds = {"float": "<f4", "uchar": "u1", "ushort": "<u2", "double": "<f8", "int": "<i4", "uint": "<u4"}
    with open(path, "rb") as file:
        header, count, properties, in_vertex = [], 0, [], False
        while (line := file.readline().decode().strip()) != "end_header":
            words = line.split()
            if words[0] == "element":
                in_vertex = words[1] == "vertex"
                count = int(words[2]) if in_vertex else count
            elif words[0] == "property" and in_vertex:
                properties.append((words[2], kinds[words[1]]))
            header.append(line)
        return header, np.fromfile(file, np.dtype(properties), count)


def read_points(path):
    """The vertex element of a binary PLY as a structured array."""
    return read_vertices(path)[1]


def plain_phase(grey, period_px):
    """Takeda's method as one would write it: `grey` in double precision, stripes along rows, no padding, a Hann window.

    Returns the unwrapped phase (masked array) and the amplitude."""
    import scipy.fft
    from skimage.restoration import unwrap_phase
    spectrum = scipy.fft.fft(grey - grey.mean(axis=0), axis=0)
    distance = (scipy.fft.fftfreq(grey.shape[0]) * period_px - 1) / 0.7
    window = np.where(np.abs(distance) < 1, 0.5 + 0.5 * np.cos(np.pi * distance), 0)
    signal = 2 * scipy.fft.ifft(spectrum * window[:, None], axis=0)
    amplitude = np.abs(signal)
    mask = amplitude < 0.25 * np.percentile(amplitude, 99)
    return unwrap_phase(np.ma.array(np.angle(signal), mask=mask)), amplitude
