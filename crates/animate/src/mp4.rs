//! H.264 by Cisco's encoder, in MP4.

use crate::format::{AnimationError, AnimationFormat, refused};
use muxide::api::{Muxer, MuxerBuilder, VideoCodec};
use openh264::OpenH264API;
use openh264::encoder::{
    ColorPrimaries, Encoder, EncoderConfig, FrameRate, IntraFramePeriod, MatrixCoefficients, RateControlMode, TransferCharacteristics,
    VuiConfig,
};
use openh264::formats::{RgbSliceU8, YUVBuffer};

/// The shortest side that H.264 is encoded with here: one block.
const SHORTEST_SIDE: usize = 16;
/// Interval of key frames (decoded without others), in pictures, so that players can seek.
const PICTURES_PER_KEY: u32 = 30;

/// H.264 in MP4, with the library's constant quantisation of 26, which is good to the eye.
///
/// Pictures of odd sizes are padded by repeating the last row or column, because colour is stored for 2 × 2 pixels, and those smaller than
/// a block are padded to one. A picture that lasts for several is repeated, so that the rate is constant.
pub(crate) struct Mp4 {
    /// Size of the pictures that are added.
    size: [usize; 2],
    /// Size of what is encoded.
    coded: [usize; 2],
    fps: f64,
    encoder: Encoder,
    muxer: Muxer<Vec<u8>>,
    pictures: u32,
    last: Option<YUVBuffer>,
}

impl Mp4 {
    pub fn begin((width, height): (u32, u32), fps: f64) -> Result<Self, AnimationError> {
        let size = [width as usize, height as usize];
        let coded = size.map(|n| n.next_multiple_of(2).max(SHORTEST_SIDE));
        // The conversion follows BT.601, whatever the size; the rest is sRGB as before.
        let color = VuiConfig::new()
            .color_primaries(ColorPrimaries::Bt709)
            .transfer_characteristics(TransferCharacteristics::Srgb)
            .matrix_coefficients(MatrixCoefficients::Smpte170M)
            .full_range(false);
        let config = EncoderConfig::new()
            .num_threads(1)
            .max_frame_rate(FrameRate::from_hz(fps as f32))
            .rate_control_mode(RateControlMode::Off)
            .skip_frames(false)
            .intra_frame_period(IntraFramePeriod::from_num_frames(PICTURES_PER_KEY))
            .vui(color);
        let refused = refused(AnimationFormat::Mp4);
        let encoder = Encoder::with_api_config(OpenH264API::from_source(), config).map_err(|e| refused(e.to_string()))?;
        let muxer = MuxerBuilder::new(Vec::new()).video(VideoCodec::H264, coded[0] as u32, coded[1] as u32, fps).with_fast_start(true);
        let muxer = muxer.build().map_err(|e| refused(e.to_string()))?;
        Ok(Self { size, coded, fps, encoder, muxer, pictures: 0, last: None })
    }

    pub fn add(&mut self, rgb: &[[u8; 3]], times: u32) -> Result<(), AnimationError> {
        let ([width, height], [coded_width, coded_height]) = (self.size, self.coded);
        let mut filled = Vec::with_capacity(3 * coded_width * coded_height);
        for y in 0..coded_height {
            let row = &rgb[y.min(height - 1) * width..][..width];
            filled.extend_from_slice(row.as_flattened());
            filled.extend_from_slice(&row[width - 1..].as_flattened().repeat(coded_width - width));
        }
        let picture = YUVBuffer::from_rgb8_source(RgbSliceU8::new(&filled, (coded_width, coded_height)));
        (0..times).try_for_each(|_| self.encode(&picture))?;
        self.last = Some(picture);
        Ok(())
    }

    fn encode(&mut self, picture: &YUVBuffer) -> Result<(), AnimationError> {
        let refused = refused(AnimationFormat::Mp4);
        let stream = self.encoder.encode(picture).map_err(|e| refused(e.to_string()))?.to_vec();
        let key = muxide::codec::h264::is_h264_keyframe(&stream);
        self.muxer.write_video(f64::from(self.pictures) / self.fps, &stream, key).map_err(|e| refused(e.to_string()))?;
        self.pictures += 1;
        Ok(())
    }

    pub fn finish(mut self) -> Result<Vec<u8>, AnimationError> {
        if self.pictures == 0 {
            return Err(refused(AnimationFormat::Mp4)("no picture".into()));
        }
        // A sample lasts until the next, so a single one would last no time.
        if let (1, Some(only)) = (self.pictures, self.last.take()) {
            self.encode(&only)?;
        }
        self.muxer.finish_in_place().map_err(|e| refused(AnimationFormat::Mp4)(e.to_string()))?;
        Ok(self.muxer.into_writer())
    }
}
