"""
Compiled kernels of mpsdem. SI units throughout.
"""
from __future__ import annotations
from . import geometry
from . import neighbors
from . import linear
from . import dem
from . import mps
from . import coupling
__all__: list[str] = ['available_threads', 'cholmod', 'compiler', 'coupling', 'dem', 'geometry', 'linear', 'mps', 'neighbors', 'simd', 'version']
def available_threads() -> int:
    """
    Threads that a parallel loop may use (OMP_NUM_THREADS, else the processors).
    """
cholmod: str
compiler: str
simd: str
version: str
