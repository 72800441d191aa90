"""OpenMM, and what `kickdrift.openmm` reads of its objects."""

from kickdrift._errors import needs

try:
    import openmm as mm
    from openmm import app, unit
except ImportError:
    raise needs("openmm") from None

__all__ = ["app", "mm", "unit"]
