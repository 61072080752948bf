"""What the user can mend."""


class UserError(Exception):
    """A message of one line that names the thing at fault; no traceback is shown."""
