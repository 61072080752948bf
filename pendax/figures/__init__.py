"""The sources' figures by their numbers."""

from ._critical import CRITICAL as CRITICAL
