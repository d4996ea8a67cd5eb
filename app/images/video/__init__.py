"""Videos as files: encoders that frames are streamed to, the way back, and the video cube."""
