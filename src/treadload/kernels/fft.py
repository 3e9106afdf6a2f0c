"""The fast Fourier transform: the one place that names its backend; another one goes in here."""

from __future__ import annotations

from scipy.fft import fft, fftfreq, ifft, irfft, irfft2, next_fast_len, rfft, rfft2, rfftfreq

__all__ = ["fft", "fftfreq", "ifft", "irfft", "irfft2", "next_fast_len", "rfft", "rfft2", "rfftfreq"]
