"""Video files: encoders to which frames are streamed, a reader, and the video cube."""
