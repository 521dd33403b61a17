"""What can go wrong, by what a program would do about it. All are SpindriftError."""


class SpindriftError(Exception):
    """Any error of this package."""


class Refused(SpindriftError):
    """The server does not want this client: another major version, a token that it does not know, a room that does not exist or was
    closed. Connecting again does not help. `close_code`: of the WebSocket, 0 if it did not open."""

    def __init__(self, message, close_code=0):
        super().__init__(message)
        self.close_code = close_code


class ConnectionLost(SpindriftError):
    """The connection broke, or was never made. Of a command: it may or may not have been carried out."""


class Rejected(SpindriftError):
    """The server did not carry out a command. `reason`: a name such as "OUT_OF_RANGE"; `field`: "splash.radius_m", or empty;
    the text says value, bound and unit."""

    def __init__(self, reason, field, message):
        super().__init__(message)
        self.reason = reason
        self.field = field


class NoAnswer(SpindriftError):
    """No answer came in time. A command may still be carried out."""


class Damaged(SpindriftError):
    """A frame broke a rule of the wire. Sessions drop such frames, count them, and ask for a new beginning."""


class ServerFailed(SpindriftError):
    """A server that `serve` started ended by itself, or did not get ready; the text holds its last lines."""
