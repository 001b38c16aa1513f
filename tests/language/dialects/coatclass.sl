/* co-shader of a layer, struct results, K&R, a method before its use, defaults from defaults */
struct Sample
{
	color f = 0;
	float pdf = 1, w;
	vector dir;
}
class coat ( float ior = 1.5, rough = .05; float f0 = (ior-1)*(ior-1)/((ior+1)*(ior+1)); color absorb = color (1, .95, .9) ; string __category = "bxdf,coat" ; ) {
	uniform float m_alpha ;
	Sample m_last ;

	public void evaluate ( vector wo, wi ; normal n ; output color f ; output float pdf ) {
		Sample smp = lookup ( wo, wi, n ) ;
		f = smp->f ; pdf = smp->pdf ;
		m_last = smp ;
	}
	Sample lookup ( vector wo, wi ; normal n ) {
		vector h = normalize ( wo + wi ) ;
		Sample r = Sample ( color ( fres ( h . wo ) ), D ( n . h ) ) ;
		r->w = r->pdf * comp ( r->f, 0 ) ; r->dir = wi ;
		return r ;
	}
	float fres ( float c ) { return f0 + ( 1 - f0 ) * pow ( 1 - abs ( c ), 5 ) ; }
	float D ( float c ) { float a2 = m_alpha * m_alpha, q = c * c * ( a2 - 1 ) + 1 ; return a2 / ( PI * q * q ) ; }
	public void construct ( ) { m_alpha = max ( rough * rough, 1e-3 ) ; }
	public color finish ( color base ) { return base * absorb + m_last->f * m_last->w ; }
}
