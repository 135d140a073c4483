"""Checks the certificate of a step: that its programs are the discrete motion of its declared texts, and nothing else.

``python -m liestep.verify FILE …``; or, without anything else of liestep, ``python -m verify FILE …`` in the folder above.
The page of the format, `core/late/src/certificate.md`, has the claims, and says what isn't proved. Standard Python alone is
needed, and no code is shared with what is checked.
"""

from .claims import verified

__all__ = ["verified"]
